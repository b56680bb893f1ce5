// Numbers, dates and words as people read them.

const kNone = "–";

const date_format = new Intl.DateTimeFormat("en-GB", { day: "numeric", month: "short", year: "numeric" });
const time_format = new Intl.DateTimeFormat("en-GB", { hour: "2-digit", minute: "2-digit" });

export function date_text(seconds: number | null | undefined): string {
  return seconds === null || seconds === undefined ? kNone : date_format.format(new Date(seconds * 1000));
}

export function date_time_text(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined) return kNone;
  const date = new Date(seconds * 1000);
  return `${date_format.format(date)}, ${time_format.format(date)}`;
}

/** A number with a fixed count of decimals and a true minus sign. */
export function fixed(value: number | null | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return kNone;
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "\u2212");
}

/** 1.4 × 10⁹ */
function power_text(value: number): string {
  const [digits, power] = value.toExponential(1).split("e");
  const raised = [...power].map((one) => (one === "-" ? "⁻" : one === "+" ? "" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(one)])).join("");
  return `${digits.replace("-", "\u2212")}\u00a0×\u00a010${raised}`;
}

/** Three significant digits: 0.0123, 1.23, 12.3, 123, 12\u202f345. */
export function number_text(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return kNone;
  if (Number.isInteger(value) && Math.abs(value) < 1000) return fixed(value, 0);
  const size = Math.abs(value);
  if (size < 1e-6) return "0";  // smaller numbers are errors of rounding
  if (size >= 1e6 || size < 1e-3) return power_text(value);
  if (size >= 1000) return String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, "\u202f").replace("-", "\u2212");
  if (size >= 100) return fixed(value, 0);
  if (size >= 10) return fixed(value, 1);
  if (size >= 1) return fixed(value, 2);
  return fixed(value, size >= 0.1 || size === 0 ? 2 : 3);
}

/** A unit to print after a number: "" for the unit 1. */
export function unit_text(unit: string): string {
  return unit === "1" || unit === "" ? "" : unit === "deg" ? "°" : unit;
}

export function with_unit(value: number | null | undefined, unit: string): string {
  const text = number_text(value);
  const name = unit_text(unit);
  return text === kNone || name === "" ? text : name === "°" ? `${text}°` : `${text}\u00a0${name}`;
}

export function percent(part: number, whole: number): string {
  return whole > 0 ? `${Math.round((100 * part) / whole)}\u00a0%` : kNone;
}

/** 75.4 s gives "1:15 min", 8.31 gives "8.3 s". */
export function duration_text(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined) return kNone;
  if (seconds < 60) return `${fixed(seconds, 1)}\u00a0s`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}\u00a0min`;
}

/** Clock of the replay: 0:58.2. */
export function clock_text(seconds: number): string {
  const tenths = Math.max(0, Math.floor(seconds * 10 + 1e-6));
  const minutes = Math.floor(tenths / 600);
  const rest = (tenths - minutes * 600) / 10;
  return `${minutes}:${rest.toFixed(1).padStart(4, "0")}`;
}

const kAbbreviations = ["csf", "ptcd"];

/** "not_scored" gives "Not scored". */
export function words(name: string | null | undefined): string {
  if (!name) return kNone;
  const text = name.replace(/_+/g, " ").replace(/(\w)-(?=\w)/g, "$1 ");
  return kAbbreviations.includes(text) ? text.toUpperCase() : text.charAt(0).toUpperCase() + text.slice(1);
}

/** "enter:supraspinous_ligament" gives "Enter: supraspinous ligament". */
export function event_text(text: string): string {
  return words(text.replace(/^(\w+):(?=\S)/, "$1: "));
}

/** "the needle went 12 mm into the colon" gives "The needle went 12 mm into the colon.". */
export function sentence(text: string): string {
  const trimmed = text.trim();
  if (!trimmed) return "";
  return `${trimmed.charAt(0).toUpperCase()}${trimmed.slice(1)}${/[.!?…]$/.test(trimmed) ? "" : "."}`;
}

const kStates: Record<string, string> = {
  running: "Not finished yet",
  finished: "Finished",
  interrupted: "Interrupted: the program ended",
  unscored: "Ended without a result",
  "never-began": "The needle never entered the body",
};
/** State of an attempt. */
export function state_text(state: string): string {
  return kStates[state] ?? words(state);
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${count} ${count === 1 ? one : many}`;
}

export const kScaleLabels = ["strongly agree", "agree", "somewhat agree", "somewhat disagree", "disagree", "strongly disagree"] as const;
