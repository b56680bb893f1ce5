// The time line: a slider over the tissues that the tip was in, with marks of the events.

import { h, svg } from "../lib/dom.ts";
import { clock_text, event_text, said_words } from "../lib/format.ts";
import type { Trace } from "../lib/types.ts";
import { t } from "../lib/words.ts";
import type { ReplayClock } from "./clock.ts";
import { index_at, tissue_at, tissue_stretches } from "./trace.ts";

const kTissueTones: [RegExp, string][] = [
  [/skin|dermis/, "skin"], [/fat|adipose|subcut/, "fat"], [/flavum|ligament|dura/, "ligament"], [/muscle|fascia/, "muscle"], [/vein|artery|aorta|vessel|blood|cava|portal/, "vessel"],
  [/lesion|target|csf|ascites|fluid|duct|bile/, "target"], [/bone|rib|vertebra/, "bone"], [/liver|spleen|kidney|organ/, "organ"],
];

export function tissue_tone(tissue: string): string {
  return kTissueTones.find(([pattern]) => pattern.test(tissue))?.[1] ?? "other";
}

export interface TimeLine {
  element: HTMLElement;
  slider: HTMLInputElement;
}

export function time_line(trace: Trace, clock: ReplayClock): TimeLine {
  const duration = clock.duration_s || 1;
  const slider = h("input", { type: "range", class: "time-slider", min: "0", max: String(clock.duration_s), step: "0.04", "aria-label": t("Time of the replay"), value: "0" });
  const strip = svg("svg", { class: "tissue-strip", viewBox: "0 0 1000 20", preserveAspectRatio: "none", "aria-hidden": "true" });
  const stretches = tissue_stretches(trace);
  for (const { tissue, start_s, end_s } of stretches) {
    strip.append(
      svg(
        "rect",
        { class: `tissue-${tissue_tone(tissue)}`, x: String((1000 * start_s) / duration), y: "0", width: String(Math.max(1, (1000 * (end_s - start_s)) / duration)), height: "20" },
        svg("title", {}, t("{0}, {1} to {2}", said_words(tissue), clock_text(start_s), clock_text(end_s))),
      ),
    );
  }
  const marks = h("div", { class: "event-marks", "aria-hidden": "true" });
  for (const event of trace.events) {
    const mark = h("span", { class: "event-mark", title: `${clock_text(event.time_s)} ${event_text(event.text)}` });
    mark.style.left = `${(100 * event.time_s) / duration}%`;
    marks.append(mark);
  }
  slider.addEventListener("input", () => clock.set_time(Number(slider.value)));
  clock.on_change(() => {
    slider.value = String(clock.time_s);
    const tissue = tissue_at(trace, index_at(trace.time_s, clock.time_s));
    const at = [clock_text(clock.time_s), clock_text(clock.duration_s)] as const;
    slider.setAttribute("aria-valuetext", tissue ? t("{0} of {1}, tip in: {2}", ...at, said_words(tissue)) : t("{0} of {1}", ...at));
  });
  const present = [...new Set(stretches.map((one) => one.tissue))];
  const legend = h(
    "ul",
    { class: "legend tissue-legend" },
    present.map((one) => h("li", {}, h("span", { class: `swatch tissue-${tissue_tone(one)}`, "aria-hidden": "true" }), said_words(one))),
  );
  return { slider, element: h("div", { class: "time-line" }, marks, slider, strip, legend) };
}
