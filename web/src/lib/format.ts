// Numbers, dates and words as people read them.

import { decimal, language, said, t } from "./words.ts";

const kNone = "–";

const kDate: Intl.DateTimeFormatOptions = { day: "numeric", month: "short", year: "numeric" };
const kTime: Intl.DateTimeFormatOptions = { hour: "2-digit", minute: "2-digit" };

/** The formats of a language: making one is slow. */
const formats = new Map<string, { date: Intl.DateTimeFormat; time: Intl.DateTimeFormat }>();

function format_of(name: "date" | "time"): Intl.DateTimeFormat {
  const code = language() === "en" ? "en-GB" : language();
  const known = formats.get(code) ?? { date: new Intl.DateTimeFormat(code, kDate), time: new Intl.DateTimeFormat(code, kTime) };
  formats.set(code, known);
  return known[name];
}

export function date_text(seconds: number | null | undefined): string {
  return seconds === null || seconds === undefined ? kNone : format_of("date").format(new Date(seconds * 1000));
}

export function date_time_text(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined) return kNone;
  const date = new Date(seconds * 1000);
  return `${format_of("date").format(date)}, ${format_of("time").format(date)}`;
}

/** A number with a fixed count of decimals and a true minus sign. */
export function fixed(value: number | null | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return kNone;
  const text = value.toFixed(decimals);
  return decimal(Number(text) === 0 ? text.replace("-", "") : text.replace("-", "\u2212"));
}

/** 1.4 × 10⁹ */
function power_text(value: number): string {
  const [digits, power] = value.toExponential(1).split("e");
  const raised = [...power].map((one) => (one === "-" ? "⁻" : one === "+" ? "" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(one)])).join("");
  return `${decimal(digits.replace("-", "\u2212"))}\u00a0×\u00a010${raised}`;
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
  return unit === "1" || unit === "" ? "" : unit === "deg" ? "°" : unit === "points" ? t("points") : unit;
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
  return `${minutes}:${decimal(rest.toFixed(1).padStart(4, "0"))}`;
}

const kAbbreviations = ["csf", "ptcd"];

/** "not_scored" gives "Not scored". */
export function words(name: string | null | undefined): string {
  if (!name) return kNone;
  const text = name.replace(/_+/g, " ").replace(/(\w)-(?=\w)/g, "$1 ");
  return kAbbreviations.includes(text) ? text.toUpperCase() : capital(text);
}

/** A name of the server in the page's language: "liver_lesion" gives "Liver lesion", or "Leberherd". */
export function said_words(name: string | null | undefined): string {
  return said(words(name));
}

/** "enter:supraspinous_ligament" gives "Enter: supraspinous ligament". */
export function event_text(text: string): string {
  const [, kind, what] = /^(\w+):\s*(\S.*)$/.exec(text) ?? [];
  if (!kind) return said_words(text);
  const name = said_words(what);
  return `${said_words(kind)}: ${name === words(what) ? what.replace(/_+/g, " ") : name}`;
}

/** With a capital letter at its beginning. */
export function capital(text: string): string {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}`;
}

/** "the needle went 12 mm into the colon" gives "The needle went 12 mm into the colon.". */
export function sentence(text: string): string {
  const trimmed = text.trim();
  if (!trimmed) return "";
  return `${capital(trimmed)}${/[.!?…]$/.test(trimmed) ? "" : "."}`;
}

const states = (): Record<string, string> => ({
  running: t("Not finished yet"),
  finished: t("Finished"),
  interrupted: t("Interrupted: the program ended"),
  unscored: t("Ended without a result"),
  "never-began": t("The needle never entered the body"),
});
/** State of an attempt. */
export function state_text(state: string): string {
  return states()[state] ?? said_words(state);
}

/** Level of help of an attempt. */
export function level_text(level: string | null): string {
  const levels: Record<string, string> = { guided: t("Guided"), assisted: t("Assisted"), exam: t("Exam") };
  return (level !== null && levels[level]) || said_words(level);
}

/** Group of a person. */
export function group_text(group: string): string {
  return group === "trainee" ? t("Trainee") : group === "expert" ? t("Expert") : said_words(group);
}

/** The points of a questionnaire's scale, 1 to 6. */
export function scale_labels(): string[] {
  return [t("strongly agree"), t("agree"), t("somewhat agree"), t("somewhat disagree"), t("disagree"), t("strongly disagree")];
}
