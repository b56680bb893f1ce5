"""Exact tables of forces and attempts."""
from . import DEVICES, MODELS, Fill, lines_of, short, signed, table


@table("insertion")
def insertion(f):
    rows = []
    for layer in ("skin", "muscle", "liver_capsule"):
        def at_speeds(profile, case, key="median", digits=2):
            return " / ".join(f"{f(f'insertion/{profile}-{speed}mm_s/{layer}-{case}', key):.{digits}f}" for speed in (2, 10, 50))
        rows.append([layer.replace("_", " "), at_speeds("paper-a", "peak") + " N", at_speeds("paper-a", "peak", "x_mm") + " mm",
                     at_speeds("tented", "peak", "x_mm") + " mm", at_speeds("paper-a", "half-drop", digits=0) + " ms"])
    return lines_of(["layer", "peak at 2 / 10 / 50 mm/s", "x at 2 / 10 / 50 mm/s, `paper-a`", "x, `tented`",
                     "half of the drop after, `paper-a`"], rows)


SLOW = "insertion/paper-a-10mm_s/"


@table("published-forces", "ct-torso", "ct-liver")
def published_forces(abdomen, torso, liver, curves):
    def peak(layer):
        return f"{abdomen(f'{SLOW}{layer}-peak'):.2f} N"
    second = "insertion/second-in-same-channel"
    patients = (abdomen, torso, liver)
    slopes = ", ".join(f"{f(SLOW + 'skin-slope'):.3f}" for f in patients)
    means = ", ".join(f"{f(SLOW + 'skin-slope', 'mean_n_per_mm'):.3f}" for f in patients)
    ways = ", ".join(f"{f(SLOW + 'skin-slope', 'puncture_mm'):.0f}" for f in patients)
    friction = abdomen(second, "second_n") / abdomen(second, "first_n")
    peaks = [abdomen(f"{SLOW}{layer}-peak") for layer in ("skin", "muscle", "liver_capsule")]
    return Fill(1, {
        "skin, peak, 17 G": peak("skin"),
        "skin, peak, 18 G": f"{curves('curves/liver-biopsy-18g/insertion/skin'):.2f} N",
        "skin, peak, 22 G": f"{curves('curves/lumbar/insertion/skin'):.2f} N",
        "all three peaks, 17 G": f"{min(peaks):.2f}–{max(peaks):.2f} N",
        "abdominal wall: muscle, 14 G": f"{curves('curves/ascites/insertion/muscle'):.2f} N",
        "muscle, 18 G": f"{curves('curves/liver-biopsy-18g/insertion/muscle'):.2f} N",
        "liver capsule, 18 G": f"{curves('curves/liver-biopsy-18g/insertion/liver_capsule'):.2f} N",
        "second insertion, same channel": f"lower by {abdomen(second):.2f} N ({abdomen(second, 'first_n'):.2f} → "
                                          f"{abdomen(second, 'second_n'):.2f} N)",
        "share of friction in the liver: second insertion to the first": f"{100 * friction:.0f} %",
        "skin, slope over the first 5 mm of indentation": f"{slopes} N/mm (embedded, `ct-torso`, `ct-liver`)",
        "skin, mean slope up to the puncture": f"{means} N/mm, after {ways} mm"})


@table("passivity")
def passivity(f):
    rows = []
    for model in ("insertion", "proxy", "combined", "probe", "finger"):
        cells = [f"{f(f'passivity/{model}/{case}', 'max'):.3f} mJ" for case in ("net", "lossless", "lossless-lost")]
        rows.append([model, *cells])
    return lines_of(["model", "made, as it is", "made, without losses", "missing, without losses"], rows)


@table("speeds")
def speeds(f):
    rows = []
    for path, title in (("lumbar", "lumbar, 22 G"), ("lumbar-tuohy-18g", "lumbar, 18 G"), ("ascites", "ascites, 14 G"),
                        ("liver", "liver, 22 G"), ("liver-biopsy-18g", "liver, 18 G")):
        for layer in ("ligamentum_flavum", "dura", "muscle", "peritoneum", "liver_capsule", "bile_duct"):
            cells = []
            for model in MODELS:
                try:
                    cells.append(f"{f(f'speeds/{path}/{model}/{layer}'):.2f}")
                except KeyError:
                    cells.append("–")
            if any(cell != "–" for cell in cells):
                rows.append([title, layer.replace("_", " "), *cells])
    return lines_of(["path", "layer", *MODELS], rows)


@table("experts", "ct-torso", "ct-liver")
def experts(*runs):
    titles = ("embedded abdomen", "`ct-liver`", "`ct-torso`")
    rows = []
    for title, expert, novice in zip(titles, runs[::2], runs[1::2]):
        layers = [f"{layer['layer'].replace('_', ' ')} {layer['depth_mm']:.1f}" for layer in expert["punctures"]]
        rows.append([title, f"{expert['score']:.0f}", ", ".join(layers),
                     f"{novice['score']:.0f}, target {'reached' if novice['target_reached'] else 'missed'}"])
    return lines_of(["patient", "expert", "punctures at, mm", "novice (seed 1)"], rows)


@table("population")
def population(printed):
    return printed.strip().splitlines()


@table("cohort", "ct-torso", "ct-liver")
def cohort(f):
    rows = []
    for patient, title in (("abdomen", "embedded abdomen"), ("ct-torso", "`ct-torso`"), ("ct-liver", "`ct-liver`")):
        name = f"cohort/{patient}"
        score = f"{name}/score"
        inward = f(f"{name}/inward", "max")
        rows.append([title, f"{f(score, 'mean'):.2f}, {f(score, 'lowest'):.0f}–{f(score, 'highest'):.0f}",
                     f"{f(score, 'reached'):.0f} of 40", "< 1e-13 N" if inward < 1e-13 else f"{inward:.2g} N",
                     f"{f(f'{name}/step', 'max'):.3f} N ({f(f'{name}/step'):.3f})",
                     f"{f(f'{name}/constraint', 'max'):.2f} N ({f(f'{name}/constraint'):.2f})"])
    return lines_of(["patient", "score: mean, range", "targets reached", "inward", "step", "largest `f_constraint`"], rows)


TOUCHED = (("rib", "between-ribs", "rib / between ribs"), ("spinous-process", "beside-the-spine", "spinous process / beside it"),
           ("xiphoid", "belly", "xiphoid / belly"),
           ("tumour", "beside-tumour", "ball of 20 mm, 60 kPa, 10 mm deep in 5 kPa / beside it"))


@table("palpation")
def palpation(f):
    rows = []
    for hard, soft, title in TOUCHED:
        pair = [f"palpation/{hard}", f"palpation/{soft}"]
        rows.append([title, " / ".join(f"{f(name):.2f}" for name in pair) + " N",
                     " / ".join(f"{f(name, 'mm_at_5_n'):.1f}" for name in pair) + " mm",
                     f"{f(f'palpation/{hard}-to-{soft}'):.2f}", f"{f(f'palpation/{hard}-to-{soft}-5-n'):.2f}"])
    return lines_of(["place", "force at 5 mm", "indentation at 5 N", "hard to soft at 5 mm", "at 5 N"], rows)


@table("transducer")
def transducer(f):
    return lines_of(["transducer, 10 mm deep", "force", "torque that rights it at 10°", "its lever"], [
        [title, f"{f(f'probe/{place}'):.1f} N", f"{f(f'probe/{place}-tilted-10-deg', 'torque_nmm'):.0f} N mm",
         f"{f(f'probe/{place}-tilted-10-deg'):.1f} mm"] for place, title in (("belly", "abdomen"), ("ribs", "ribs"))])


@table("published-touch")
def published_touch(f):
    probes = [f(f"probe/{place}") for place in ("belly", "ribs")]
    return Fill(1, {
        "force of a hand on an abdominal probe":
            f"{min(probes):.1f}–{max(probes):.1f} N at 10 mm, to the device's limit deeper",
        "palpation of the abdomen, light and deep": f"{f('palpation/belly'):.2f} N at 5 mm, "
                                                    f"5 N at {f('palpation/belly', 'mm_at_5_n'):.0f} mm"})


@table("proxy-peaks")
def proxy_peaks(f):
    def peak(path, layer):
        return f"{f(f'curves/{path}/proxy/{layer}'):.2f} N"
    skin = "curves/liver-biopsy-18g/proxy/skin"
    return Fill(1, {
        "skin, peak, 18 G": peak("liver-biopsy-18g", "skin"),
        "skin, mean slope at the device, 18 G": f"{f(skin) / f(skin + '/way'):.2f} N/mm",
        "fat to muscle, a border of the CT, 18 G": f"{f('curves/liver-biopsy-18g/proxy/border-of-muscle', 'peak_n'):.2f} N",
        "peritoneum, 14 G": peak("ascites", "peritoneum"),
        "liver capsule, 18 G": peak("liver-biopsy-18g", "liver_capsule"),
        "ligamentum flavum, 18 G": peak("lumbar-tuohy-18g", "ligamentum_flavum"),
        "ligamentum flavum, 22 G": peak("lumbar", "ligamentum_flavum"),
        "dura, 22 G": peak("lumbar", "dura"),
        "bile duct, 22 G": peak("liver", "bile_duct")})


@table("stability")
def stability(f):
    rows = []
    for device in DEVICES:
        cells = []
        for model in MODELS:
            name = f"stability/{model}/{device}"
            cells.append(f"{f(name, 'stable'):.0f}, {f(name + '/force'):.2f} N, {short(f(name + '/energy'))} mJ")
        rows.append([device, *cells])
    names = [[f"stability/{model}/{device}" for device in DEVICES] for model in MODELS]
    runs = sum(f(name, "runs") for name in names[0])
    rows.append([f"of {runs:.0f} each", *(f"{sum(f(name, 'stable') for name in of):.0f}" for of in names)])
    return lines_of(["device", *MODELS], rows)


@table("coupling")
def coupling(f):
    rows = []
    for device in DEVICES:
        spring, damping = f"coupling/{device}/spring", f"coupling/{device}/damping"
        rows.append([device, f"{f(spring):.2f} N/mm", f"{f(spring, 'low'):.3f}–{f(spring, 'high'):.3f} N/mm",
                     f"{f(spring, 'limit'):.1f} N/mm", f"{f(damping):.1f} ms",
                     f"{f(damping, 'low'):.1f}–{f(damping, 'high'):.1f} ms", f"{f(f'coupling/{device}/margin'):.0f}"])
    return lines_of(["device", "k_c", "alone stable", "device's limit", "b_c/k_c", "alone stable", "unstable of the 9 couplings"],
                    rows)


def by_device(cell):
    return lines_of(["device", *MODELS], [[device, *(cell(device, model) for model in MODELS)] for device in DEVICES])


@table("bone")
def bone(f):
    def cell(name):
        return (f"{f(name + '/slope'):.2f} N/mm, {f(name):.2f} N, {100 * f(name, 'overshoot'):.0f} %, "
                f"{f(name, 'ripple_n'):.2f} N")
    return by_device(lambda device, model: cell(f"contact/bone/{device}/{model}"))


@table("flavum")
def flavum(f):
    def cell(name):
        return (f"{f(name):.2f} N, {f(name + '/drop'):.2f} N, {f(name + '/drop-time'):.0f} ms "
                f"({f(name + '/drop-time-model'):.0f} ms), {f(name + '/jump'):.1f} mm")
    return by_device(lambda device, model: cell(f"contact/flavum/{device}/{model}"))


def paths_rows(titles, studies):
    rows = []
    for title, f in zip(titles, studies):
        rows.append([title, f"{f('paths/mean-rms'):.3f} N", f"{f('paths/rms'):.3f} N", f"{f('paths/rms', 'max'):.3f} N",
                     f"{f('paths/mean-max'):.2f} N", f"{f('paths/max', 'max'):.2f} N", f"{f('paths/max-apart', 'max'):.2f} N",
                     where(f.note("paths/max-apart")), f"{100 * f('paths/affected'):.1f} %",
                     f"{float(f.note('paths/torque-rms').rsplit(' ', 1)[1]):.1f} N mm"])
    return lines_of(["patient, model", "mean rms", "rms, median", "rms, largest", "mean of the max", "max", "max apart", "where",
                     "affected", "torque rms, mean"], rows)


def where(note):
    """ "22.1 mm deep, adipose > muscle; skin gives way in one only" of the note of max-apart."""
    place = note.split(" s, ", 1)[1] if " s, " in note else note.split("; ", 1)[1]
    return place.replace("_", " ").replace("in ct", "in the CT")


@table("paths-torso", "ct-torso")
def paths_torso(*studies):
    return paths_rows(("`ct-torso`, proxy", "`ct-torso`, combined"), studies)


@table("paths", "ct-torso", "ct-liver")
def paths(*studies):
    return paths_rows([f"{patient}, {model}" for model in ("proxy", "combined") for patient in
                       ("embedded abdomen", "`ct-torso`", "`ct-liver`")], studies)


@table("paths-unlabelled", "ct-torso", "ct-liver")
def paths_unlabelled(*studies):
    return paths(*studies)


CURVES = (("lumbar", "lumbar, Quincke 22 G"), ("lumbar-tuohy-18g", "lumbar, Tuohy 18 G"), ("ascites", "ascites, 14 G"),
          ("liver", "liver, Chiba 22 G"), ("liver-biopsy-18g", "liver, biopsy needle 18 G"))


@table("curves")
def curves(f):
    """Layers in the order of the first model that has them; a layer without a puncture in some model has a border there."""
    rows = []
    for path, title in CURVES:
        layers = []
        for model in MODELS:
            start = f"curves/{path}/{model}/"
            found = [name[len(start):] for name in f.cases if name.startswith(start) and name.count("/") == 3]
            layers += [layer for layer in found if layer not in layers and not layer.startswith("border-of-")]
            layers += [layer for layer in found if layer not in layers and layer.startswith("border-of-")]
        layers.sort(key=lambda layer: first_way(f, path, layer))
        for layer in layers:
            rows.append(["" if rows and layer != layers[0] else title, layer.replace("-", " ").replace("_", " "),
                         *(curve_cell(f, f"curves/{path}/{model}/{layer}") for model in MODELS)])
    return lines_of(["scene, needle", "layer", "insertion: peak at, drop", "proxy", "combined"], rows)


def first_way(f, path, layer):
    """Order of a layer; a border comes behind the punctured layer of its name, which has a place."""
    plain = layer.removeprefix("border-of-")
    ways = [f(f"curves/{path}/{model}/{plain}/way") for model in MODELS if f"curves/{path}/{model}/{plain}/way" in f.cases]
    return (min(ways) if ways else 1e9, layer != plain)


def curve_cell(f, name):
    if name not in f.cases:
        return "–"
    if "border-of-" in name:
        return f"{f(name, 'peak_n'):.2f} N, tip {f(name):.1f} mm behind it"
    return (f"{f(name):.2f} N at {f(name + '/way'):.1f} mm, {signed(-f(name + '/drop'))} N in "
            f"{f(name + '/fall'):.0f} ms")
