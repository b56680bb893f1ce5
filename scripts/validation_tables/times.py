"""Tables of times: measurement, limit, figure."""
from . import lines_of, table


SECONDS = {"us": 1e-6, "µs": 1e-6, "ms": 1e-3, "s": 1.0}


def timed(f, title, limit, unit, case, digits=2, key="median"):
    """A row: the figure of a case, bold if it is beyond the limit ("≤ 0.6"; "" is none); then what else it has."""
    found = f.cases[case]
    scale = 100.0 if (found["unit"], unit) == ("ratio", "%") else 1.0
    if found["unit"] in SECONDS:
        scale = SECONDS[found["unit"]] / SECONDS[unit]
    value = f"{scale * f(case, key):.{digits}f}"
    more = [f"{name} {scale * found[field]:.{digits}f}" for name, field in (("p99", "p99"), ("p99.9", "p999"), ("max", "max"))
            if key == "median" and found.get(field) is not None]
    if found["peer"]:
        more.append(f"{found['peer']['ratio']:.1f} times as fast as {found['peer']['name']}")
    figure = f"{value} {unit}"
    if limit and not keeps(value, limit):
        figure = f"**{figure}**"
    return [title, f"{limit} {unit}" if limit else "–", figure + (f" ({', '.join(more)})" if more else "")]


def keeps(value, limit):
    sign, bound = limit.split(" ")
    return float(value) <= float(bound) if sign == "≤" else float(value) >= float(bound)


def times(f, *rows):
    return lines_of(["measurement", "limit", "measured"], [timed(f, *row) for row in rows])


OPENED = (("", "embedded abdomen"), ("-50m", "a patient of 50 million voxels"))


@table("speed")
def speed(f):
    tick = "of the calibration loop"
    return times(
        f, ("512×512 oblique trilinear slice of 256³, one core", "≤ 0.6", "ms", "slice/512-oblique"),
        ("30 simulated seconds at 1 kHz: loop, recording, score", "≤ 1.5", "s", "session/loop"),
        ("the whole process, patient load and planning included", "≤ 3", "s", "session/process"),
        ("one tick, proxy model, 16 body proxies and bending, 512×512×119 voxels", "≤ 10", "µs", "tick/needle16-bending"),
        ("the same, to the calibration loop", "≤ 0.25", tick, "tick/needle16-bending-to-calibration"),
        ("one tick, combined model", "≤ 0.25", tick, "tick/combined16-bending-to-calibration"),
        ("one tick, insertion model", "≤ 0.25", tick, "tick/insertion-to-calibration"),
        *((f"{patient}, first opening until an attempt can begin", "≤ 10", "s", f"open/first{case}", 1)
          for case, patient in OPENED),
        *((f"{patient}, again from the cache", "≤ 3", "s", f"open/again{case}", 1) for case, patient in OPENED))


@table("servers")
def servers(f):
    rows = []
    for rate in (1000, 4000):
        for tool, title in (("needle", "needle"), ("probe", "transducer")):
            name = f"servers/{tool}-{rate}hz/"
            rows += [(f"{title} at {rate} Hz: periods served", "≥ 99.9", "%", name + "served"),
                     ("its lateness, p99", "≤ 100", "µs", name + "lateness", 0, "p99"),
                     ("its lateness", "", "µs", name + "lateness", 0), ("its tick", "", "µs", name + "tick", 0)]
    return times(f, *rows)


@table("serve")
def serve(f):
    return times(f, *((f"first request, empty caches: {page}", "≤ 300", "ms", f"serve/first/{page}", 0)
                      for page in ("validity", "path length", "attempt", "overview")),
                 ("200 readers, each a page a second, p99", "≤ 100", "ms", "serve/200 readers, a page a second", 1, "p99"),
                 ("200 readers without a pause", "", "ms", "serve/200 readers without a pause", 1),
                 ("a list of attempts beside 8 exports of 100,000 attempts, p99", "≤ 300", "ms", "serve/a page beside 8 exports", 0, "p99"),
                 ("8 exports at once, until the last one has ended", "", "s", "serve/8 exports at once", 0),
                 ("filling the database, 100,000 attempts", "", "s", "serve/fill", 0))


@table("ultrasound")
def ultrasound(f):
    frames = (("raycast/256x1024x5", "C5-2", "≥ 60"), ("raycast/256x1024x5-one-look", "C5-2, one steering angle", ""),
              ("raycast/liver-sweep", "liver-sweep", "≥ 60"), ("raycast/linear", "L14-5", "≥ 60"),
              ("raycast/rolling-quarter", "a quarter of the scanlines renewed", ""),
              ("raycast/rolling-eighth", "an eighth of the scanlines renewed", ""),
              ("panorama/640x480", "panorama, fully covered", "≥ 120"),
              ("panorama/640x480-needle", "panorama with a needle", ""), ("panorama/640x480-half", "panorama, half covered", ""))
    return times(f, *((title, limit, "frames/s", case, 0) for case, title, limit in frames))


@table("ultrasound-cost")
def ultrasound_cost(f):
    rows = []
    for title, cases in (("128, 256, 512 scanlines", ("lines-128", "lines-256", "lines-512")),
                         ("80, 120, 160, 240 mm", ("depth-80mm", "depth-120mm", "depth-160mm", "depth-240mm")),
                         ("3, 5, 9 planes", ("planes-3", "planes-5", "planes-9")),
                         ("4, 2 scatterers a cell", ("scatterers-4", "scatterers-2")),
                         ("1, 2, 4, 8 threads", ("threads-1", "threads-2", "threads-4", "threads-8")),
                         ("detail fast, middle, full, one thread", ("level-fast", "level-middle", "level-full"))):
        rows.append([title, ", ".join(f"{f('ultrasound-cost/' + case):.1f}" for case in cases)])
    return lines_of(["setting", "ms"], rows)


@table("sift")
def sift(f):
    return times(
        f, ("shadow mask, flattening, scale space, keypoints, a million voxels", "≤ 0.5", "s", "sift/keypoints-per-mvoxel", 3),
        ("descriptor of 2048 elements, orientation included", "≤ 0.5", "ms", "sift/descriptor"),
        ("13,500 by 13,500 descriptors, exact, both directions", "≤ 4", "s", "sift/match-13500", 1))


@table("ct-us")
def ct_us(f):
    rows = []
    for program, error, seconds in (("`trocar register`", "error", "seconds"), ("elastix 5.0.1", "elastix-error", None),
                                    ("plastimatch", "plastimatch-error", None)):
        name = f"ct-us/{error}"
        rows.append((f"{program}: error, median of ten", "≤ 0.5" if seconds else "", "mm", name))
        rows.append((f"{program}: error, worst", "≤ 0.8" if seconds else "", "mm", name, 2, "max"))
        if seconds:
            rows.append((f"{program}: time, beside elastix", "", "s", f"ct-us/{seconds}"))
            rows.append((f"{program}: time, beside plastimatch", "", "s", f"ct-us/{seconds}-plastimatch"))
    return times(f, *rows)


@table("xray")
def xray(f):
    views = (("drr/512", "projection of 256³ to 512×512, AP: water and bone"), ("drr/512-lao-30", "LAO 30"),
             ("drr/512-lao-45-cranial-25", "LAO 45, cranial 25"), ("drr/512-lateral", "lateral"))
    return times(f, *((title, "", "ms", case, 1) for case, title in views),
                 ("signal over the spectrum from the masses, 512×512", "", "ms", "drr/512-poly", 1),
                 ("volume of basis materials of the embedded abdomen, once", "", "ms", "drr/volume", 0),
                 ("masses and signal of this patient, C-arm turning at each frame (15 frames/s)", "≤ 66.7", "ms",
                  "drr/512-moving", 1),
                 ("fluoroscopy, C-arm still; needle, wire and ducts change (30 frames/s)", "≤ 33.3", "ms",
                  "fluoroscopy/512-static", 1),
                 ("fluoroscopy, C-arm turning (15 frames/s)", "≤ 66.7", "ms", "fluoroscopy/512-moving", 1),
                 ("tree of bile ducts of `ptcd-1` at 1.5 mm, once", "", "ms", "contrast/ducts", 0),
                 ("contrast agent in these ducts, 33 ms: flow and pieces", "", "ms", "contrast/step"))


@table("live")
def live(f):
    return times(f, ("renewed pictures", "≥ 20", "/s", "live/ultrasound", 1),
                 ("one of them", "", "ms", "live/ultrasound/picture", 1))
