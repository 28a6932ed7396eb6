"""Repeats parts of the tables on a few small frames and compares figures with expected.json.

expected.json has the `tolerances`, each with its reason, and the `figures`: the table, words of the row's cells, the
column, the value, the tolerance's name and, for a recording, its folder in --tum as `data`.
"""
import dataclasses
import json
import pathlib
import re

EXPECTED = pathlib.Path(__file__).with_name("expected.json")
# Table -> sequences. A table that is not listed is made with all of its sequences.
ONLY = {"b14-table1": ("floor_kinect",), "d18-table2": ("desk_kinect",), "low-structure": ("floor_kinect", "wall_kinect"),
        "presets": ("desk_kinect", "house_desk", "tum_fr1_xyz_third")}
ROUNDING = 1e-9  # a difference of printed figures may be exactly the tolerance
NUMBER = re.compile(r"^-?\d+(\.\d+)?")


class NoSuchFigure(ValueError):
    """expected.json names a figure that the table does not have."""


@dataclasses.dataclass(frozen=True)
class Result:
    """One comparison: `limit` is how far `found` may be from the expected value."""
    figure: dict
    found: float
    limit: float

    def holds(self):
        return abs(self.found - self.figure["value"]) <= self.limit + ROUNDING

    def line(self):
        return (f"{name_of(self.figure)}: expected {self.figure['value']:g}, got {self.found:g}, tolerance "
                f"{self.limit:.3g} ({self.figure['tolerance']})")


def name_of(figure):
    return ", ".join((figure["table"], *figure["row"], figure["column"]))


def read(path=EXPECTED):
    """The content of expected.json. Raises ValueError with the file's name if it is no such file."""
    try:
        expected = json.loads(path.read_text(encoding="utf-8"))
        for figure in expected["figures"]:
            missing = {"table", "row", "column", "value", "tolerance"} - set(figure)
            missing |= {"relative", "least", "why"} - set(expected["tolerances"][figure["tolerance"]])
            if missing:
                raise KeyError(*sorted(missing))
    except (KeyError, TypeError, json.JSONDecodeError) as error:
        raise ValueError(f"{path}: {error!r}; see scripts/reproduction/check.py for the format") from None
    return expected


def write(expected, path=EXPECTED):
    """One line per figure, so that a change of one is a change of one line."""
    tolerances = ",\n".join(f"  {json.dumps(name)}: {json.dumps(rule, ensure_ascii=False)}"
                            for name, rule in expected["tolerances"].items())
    figures = ",\n".join(f"  {json.dumps(figure, ensure_ascii=False)}" for figure in expected["figures"])
    path.write_text(f'{{\n "tolerances": {{\n{tolerances}\n }},\n "figures": [\n{figures}\n ]\n}}\n', encoding="utf-8")


def cell(document, figure):
    """The number at the start of the one cell with this column whose row has all of these words as cells."""
    found = [row[header.index(figure["column"])] for _, header, rows in document.tables if figure["column"] in header
             for row in rows if set(figure["row"]) <= set(row)]
    if len(found) != 1 or not NUMBER.match(str(found[0])):
        what = f"{len(found)} such cells" if len(found) != 1 else f"no number but '{found[0]}'"
        raise NoSuchFigure(f"{name_of(figure)}: the table has {what}; correct {EXPECTED.name} or the table")
    return float(NUMBER.match(str(found[0]))[0])


def compare(document, figures, tolerances):
    """Results for the figures of one table."""
    results = []
    for figure in figures:
        rule = tolerances[figure["tolerance"]]
        limit = max(rule["relative"] * abs(figure["value"]), rule["least"])
        results.append(Result(figure, cell(document, figure), limit))
    return results


def is_here(bench, figure):
    return "data" not in figure or (bench.tum is not None and (bench.tum / figure["data"]).is_dir())


def run(bench, tables, expected):
    """Makes each table and compares its figures. Returns the results, and the lines about what was skipped."""
    here = [figure for figure in expected["figures"] if is_here(bench, figure)]
    absent = sorted({figure["data"] for figure in expected["figures"] if not is_here(bench, figure)})
    results = []
    for name, make in tables.items():
        bench.only = ONLY.get(name, ())
        document = make(bench)
        document.markdown(bench.version)  # its rows must fit
        results += compare(document, [figure for figure in here if figure["table"] == name], expected["tolerances"])
    return results, [f"skipped: {name} is not in --tum" for name in absent]


def update(expected, results, path=EXPECTED):
    """Writes the figures found. Returns a line for each that changed."""
    lines = []
    for result in results:
        if result.found != result.figure["value"]:
            lines.append(f"{name_of(result.figure)}: {result.figure['value']:g} is now {result.found:g}")
            result.figure["value"] = result.found
    write(expected, path)
    return lines
