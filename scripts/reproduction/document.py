"""The Markdown file of a table: caption, figures, protocol, exact commands, versions."""
import dataclasses
import math
import platform


@dataclasses.dataclass
class Document:
    """`tables` are (caption, header, rows of cells), `pictures` (file beside the document, caption)."""
    title: str
    source: str = ""
    tables: list = dataclasses.field(default_factory=list)
    pictures: list = dataclasses.field(default_factory=list)
    protocol: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)
    commands: list = dataclasses.field(default_factory=list)

    def markdown(self, version):
        parts = [f"# {self.title}\n"]
        if self.source:
            parts.append(self.source + "\n")
        for caption, header, rows in self.tables:
            parts.append((caption + "\n\n" if caption else "") + table(header, rows))
        parts += [f"![{caption}]({file})\n\n{caption}\n" for file, caption in self.pictures]
        if self.notes:
            parts.append("\n".join(f"- {note}" for note in self.notes) + "\n")
        if self.protocol:
            parts.append("## Protocol\n\n" + "\n".join(f"- {line}" for line in self.protocol) + "\n")
        parts.append("## Commands\n\n" + "\n".join(f"    {line}" for line in self.commands) + "\n")
        parts.append(footer(version))
        return "\n".join(parts)


def footer(version):
    """The last line of each file. `version`: the program's."""
    return f"Versions: {version}; Python {platform.python_version()}; {platform.machine()}.\n"


def table(header, rows):
    """A Markdown table; every row must have as many cells as the header."""
    for row in rows:
        if len(row) != len(header):
            raise ValueError(f"row of {len(row)} cells under {len(header)} headings: {row}")
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def number(value, digits=4):
    """Formats a number. None and NaN become a dash."""
    return "–" if value is None or math.isnan(value) else f"{value:.{digits}f}"


def ratio(ours, paper):
    """Our figure divided by the paper's: below 1 is better. A dash if either is missing or the paper's is 0."""
    if ours is None or not paper or math.isnan(ours):
        return "–"
    return f"{ours / paper:.2f}"
