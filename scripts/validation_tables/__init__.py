"""How scripts/validation makes the rows of the tables of docs/validation.md: a function for each table, by its name."""
import json
from types import SimpleNamespace

MODELS = ("insertion", "proxy", "combined")
DEVICES = ("premium", "omni", "desktop", "omega6", "omega7", "sigma7", "delta6", "falcon", "inverse3")


class Figures:
    """The cases of one or more benchmarks in one run (--json), by name."""

    def __init__(self, printed):
        said = json.loads(printed)
        benches = said.get("benches", [said])
        self.machine = benches[0]["machine"]
        self.cases = {case["case"]: case for bench in benches for case in bench["results"]}

    def __call__(self, case, key="median"):
        found = self.cases[case]
        value = found[key] if key in found else found["values"][key]
        if value is None:
            raise KeyError(f"{case} {key}")
        return value

    def note(self, case):
        return self.cases[case]["note"]

    def peer(self, case):
        return SimpleNamespace(**self.cases[case]["peer"]) if self.cases[case]["peer"] else None


RENDERERS = {}


def table(name, *needs):
    """Registers the function that makes the table: from one Figures (or parsed text) a command to lines, or to a Fill.
    needs: folders of the test data that its commands read."""
    def register(function):
        RENDERERS[name] = SimpleNamespace(rows=function, needs=needs)
        return function
    return register


class Fill(dict):
    """New texts of one column, by the first cell of their rows; what else stands in the table (published figures) stays."""

    def __init__(self, column, cells):
        super().__init__(cells)
        self.column = column


def lines_of(header, rows):
    head, *body = (f"| {' | '.join(row)} |" for row in (header, *rows))
    return [head, "|" + "---|" * len(header), *body]


def signed(value, digits=2):
    return f"{value:.{digits}f}".replace("-", "−")


def short(value):
    """Two significant digits, without an exponent."""
    return f"{float(f'{value:.2g}'):.4f}".rstrip("0").rstrip(".")


from . import forces, other, times  # noqa: E402,F401: they register their tables
