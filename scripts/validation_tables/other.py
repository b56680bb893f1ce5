"""Exact tables of other results."""
import re

from . import DEVICES, lines_of, table


@table("faults")
def faults(f):
    rows = []
    for ms in (0, 1, 2, 3, 5, 8, 12, 20, 30, 50, 100, 200, 240, 400, 1000):
        names = [f"faults/{device}/reading-{ms}ms" for device in DEVICES]
        said = [f.note(name) for name in names]
        faults_first = sorted(set(said), key=lambda fault: (fault == "none", fault))
        counts = [f"{fault} on {said.count(fault)}" for fault in faults_first]
        faulty = [name for name, fault in zip(names, said) if fault != "none"]
        latest = [f"{max(f(name, key) for name in faulty):.0f} ms" if faulty else "–" for key in ("latch_ms", "zero_ms")]
        share = min(f(name, "share") for name in names)
        rows.append([f"{ms} ms" if ms else "healthy", f"{share:.3f}", ", ".join(counts), *latest,
                     f"{max(f(name, 'force_n') for name in names):.2f} N",
                     f"{max(f(name, 'travel_mm') for name in names):.1f} mm"])
    return lines_of(["reading takes", "smallest share of the coupling", "fault", "latched after", "zero force after",
                     "largest force", "travel"], rows)


@table("likeness", "us-liver-sweep")
def likeness(f):
    rows = []
    for depth in range(35, 126, 10):
        row = [str(depth)]
        for what, digits in (("patch-gray", 1), ("patch-sd", 1), ("axial", 2), ("lateral", 2)):
            for of in ("recorded", "abdomen"):
                row.append(f"{f(f'likeness/{of}/{what}-{depth}mm'):.{digits}f}")
        rows.append(row)
    header = ["depth, mm"]
    for what in ("gray", "sd", "axial mm", "lateral mm"):
        header += [f"{what}, recorded", "simulated"]
    return lines_of(header, rows)


@table("picture", "us-liver-sweep", "ct-liver")
def picture(abdomen, liver):
    figures = (("organ at 40–100 mm, skewness", "organ-skewness", 2), ("kurtosis", "organ-kurtosis", 2),
               ("pixels beyond 4 standard deviations, per mille", "organ-bright-permille", 2),
               ("diaphragm at 25–45° incidence: gray values above the liver", "border-above", 0),
               ("its thickness, mm", "border-thickness", 1))
    rows = [[what, *(f"{f(f'likeness/{of}/{key}'):.{digits}f}" for f, of in
                     ((abdomen, "recorded"), (abdomen, "abdomen"), (liver, "ct-liver")))] for what, key, digits in figures]
    rows.append(["earth mover's distance of the histograms, gray values per pixel", "–",
                 *(f"{f('likeness/histogram-moved'):.1f}" for f in (abdomen, liver))])
    return lines_of(["figure", "recorded", "embedded patient", "`ct-liver`"], rows)


@table("reconstruct", "us-spine-phantom", "us-liver-sweep")
def reconstruct(f):
    return lines_of(["spine phantom against the volume of PLUS", "limit", "measured"], [
        ["normalized cross-correlation, all voxels", "≥ 0.97", f"{f('reconstruct/spine-phantom-ncc'):.4f}"],
        ["where both have echoes", "≥ 0.97", f"{f('reconstruct/spine-phantom-ncc-both'):.4f}"]])


STITCHED = (("half-overlap", "`half-overlap`, 15° between neighbours"),
            ("half-overlap-controls", "`half-overlap-controls`, ±6 dB of gain, another TGC and gray map each"),
            ("half-overlap-30deg", "`half-overlap-30deg`"),
            ("half-overlap-sparse", "`half-overlap-sparse`, half as many vessels and ellipsoids"),
            ("sweeps-25deg", "`sweeps-25deg`: six sweeps of the embedded patient, refraction and range distortion off"),
            ("sweeps-40deg", "`sweeps-40deg`, the same"),
            ("sweeps-25deg-distorted", "`sweeps-25deg-distorted`: with refraction and range distortion"),
            ("sweeps-40deg-distorted", "`sweeps-40deg-distorted`"),
            ("recorded-liver", "`recorded-liver`: three parts of the recorded sweep, turned by 10°"),
            ("recorded-spine-phantom", "`recorded-spine-phantom`, 0.5 mm"),
            *((f"{kind}-{percent}percent", f"{kind} {percent} % of every second volume, about its middle; the error contains it")
              for kind in ("scale", "shear") for percent in (1, 3, 6, 10)))


@table("stitch", "us-liver-sweep", "us-spine-phantom")
def stitch(f):
    rows = []
    for case, title in STITCHED:
        name = f"stitch/{case}"
        rows.append([title, f"{f(name, 'placed'):.0f} of {f(name, 'volumes'):.0f}", f"{f(name):.2f} mm",
                     f"{f(name, 'max'):.2f} mm", f"{f(name, 'largest_mm'):.2f} mm"])
    return lines_of(["case", "placed", "median", "largest mean", "largest target"], rows)


@table("variants")
def variants(printed):
    kept, tried = re.search(r"(\d+) of (\d+) bodies are sound", printed).groups()
    return lines_of(["seeds", "sound, and serve their task"], [[tried, kept]])


HARM_TASKS = ("liver-biopsy", "lumbar-puncture", "ascites-puncture", "ptcd")
GRADES = ("none", "minor", "major", "critical")


@table("harm")
def harm(f):
    names = sorted({case.split("/")[2] for case in f.cases if case.split("/")[1] in HARM_TASKS})
    rows = []
    for name in names:
        cells = []
        for task in HARM_TASKS:
            case = f"harm/{task}/{name}"
            if case not in f.cases:
                cells.append("–")
                continue
            verdict = ["not passed", "passed"]
            cells.append(f"{GRADES[int(f(case, 'grade'))]}; {f(case):.0f}, {verdict[int(f(case, 'by_sum'))]} → "
                         f"{verdict[int(f(case, 'passed'))]}")
        rows.append([name, *cells])
    for operator, title in (("expert", "**good attempts**: experts"), ("novice:0.1", "**good attempts**: a tenth of a novice's errors")):
        case = f"harm/good/{operator}"
        rows.append([title, f"{f(case):.0f} of {f(case, 'all'):.0f} passed, {f(case, 'harmed'):.0f} with a harm", "", "", ""])
    return lines_of(["structure on the way", *HARM_TASKS], rows)
