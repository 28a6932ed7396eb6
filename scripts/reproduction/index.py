"""all.md, the list of tables that one program made, and the check that their files agree."""
import re

from .document import footer, table

FILE = "all.md"
FOOTER = re.compile(r"^Versions: (.*);", re.MULTILINE)


def write(out, titles, version):
    """`titles`: table -> title. Returns the path."""
    cells = [[f"[{name}]({name}.md)", title] for name, title in titles.items()]
    path = out / FILE
    path.write_text(f"# The papers' tables\n\nAll are made by one program: {version}.\n\n" +
                    table(["table", "what"], cells) + "\n" + footer(version), encoding="utf-8")
    return path


def program_of(path):
    """The version in a file's last line. None if there is no such file or line."""
    found = FOOTER.findall(path.read_text(encoding="utf-8")) if path.is_file() else []
    return found[-1].split(";")[0] if found else None


def strangers(folder):
    """Tables listed in the folder's all.md that another program made or that are missing: (file, its program)."""
    if not (folder / FILE).is_file():
        return []
    program = program_of(folder / FILE)
    listed = re.findall(r"^\| \[.*?\]\((.*?)\)", (folder / FILE).read_text(encoding="utf-8"), re.MULTILINE)
    return [(file, program_of(folder / file)) for file in listed if program_of(folder / file) != program]
