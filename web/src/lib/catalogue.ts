// A language's texts by their English ones, which may have places: "Needle {0} mm from the target". Pure functions.
// The algorithm is that of src/foundation/language: the page and the trainer's window translate a sentence alike.

export interface Catalogue {
  /** Between whole digits and decimals. */
  decimal_sign: string;
  texts: Map<string, string>;
  /** Those with more fixed characters first. */
  patterns: Pattern[];
}
interface Pattern {
  /** The fixed parts around the places {0}, {1} …: one more than places. */
  fixed: string[];
  weight: number;
  text: string;
}
interface Found {
  text: string;
  /** Nothing of it stayed English. */
  is_whole: boolean;
}
/** One translation: what was found already, so that a text of many parts is not tried again and again. */
interface Search {
  catalogue: Catalogue;
  known: Map<string, Found>;
  /** How many more parts are looked up: a text made to have endless parts must not stop the page. */
  left: number;
}

/** Places within places: a sentence, a quantity in it, the name in that. */
const kDeepest = 6;
/** No text of the program is longer. */
const kMostLength = 4000;
const kMostParts = 400;
/** Units are the same in every language. */
const kUnits = new Set("mm cm m N mN s ms min h Hz kHz MHz dB ml mJ J kPa Pa HU G kV mA mAs mGy Gy MPa fps kg MB GB Nm x".split(" "));
const kPlace = /\{(\d+)\}/g;

/** Numbers of the places of a text, in their order: [1, 0] of "{1} of {0}". */
export function places_of(text: string): number[] {
  return [...text.matchAll(kPlace)].map((one) => Number(one[1]));
}

/** The text with `values` in its places. A value is never read as a text with places, a place without a value stays. */
export function filled(text: string, values: readonly (string | number)[]): string {
  return text.replace(kPlace, (place, number: string) => String(values[Number(number)] ?? place));
}

/** "1.5 to 2.5 mm" with the language's sign; "0.1.0" is a version. */
export function with_sign(text: string, decimal_sign: string): string {
  return text.replace(/\d[\d.]*\d/g, (number) => (number.split(".").length === 2 ? number.replace(".", decimal_sign) : number));
}

export function make_catalogue(texts: Record<string, string>, decimal_sign: string): Catalogue {
  const patterns: Pattern[] = [];
  for (const [english, text] of Object.entries(texts)) {
    const fixed = english.split(/\{\d+\}/);
    const weight = fixed.reduce((sum, one) => sum + one.length, 0);
    if (fixed.length > 1 && weight > 0) patterns.push({ fixed, weight, text });
  }
  patterns.sort((a, b) => b.weight - a.weight);
  return { decimal_sign, texts: new Map(Object.entries(texts)), patterns };
}

/** "19 × 18 mm", "−3.5 N", "–". */
function is_quantity(text: string): boolean {
  return (text.match(/[A-Za-z]+/g) ?? []).every((one) => kUnits.has(one));
}

/** What stands in the places; null if the text does not fit. A place is never empty, and as short as possible. */
function places_in({ fixed }: Pattern, text: string): string[] | null {
  const last = fixed[fixed.length - 1];
  if (!text.startsWith(fixed[0]) || !text.endsWith(last)) return null;
  const places: string[] = [];
  let from = fixed[0].length;
  for (let n = 1; n < fixed.length; n += 1) {
    const at = n === fixed.length - 1 ? text.length - last.length : text.indexOf(fixed[n], from + 1);
    if (at <= from) return null;
    places.push(text.slice(from, at));
    from = at + fixed[n].length;
  }
  return places;
}

/** Also "Liver" where the catalogue has "liver": a name at the beginning of a line. */
function exact({ texts }: Catalogue, english: string): string | null {
  const found = texts.get(english);
  if (found !== undefined || !/^[A-Z]/.test(english)) return found ?? null;
  const small = texts.get(english.charAt(0).toLowerCase() + english.slice(1));
  return small === undefined ? null : small.charAt(0).toUpperCase() + small.slice(1);
}

function by_pattern(search: Search, english: string, depth: number): Found | null {
  let partial: Found | null = null;
  for (const pattern of search.catalogue.patterns) {
    const places = pattern.weight < english.length ? places_in(pattern, english) : null;
    if (!places) continue;
    const found = places.map((one) => search_for(search, one, depth + 1));
    const whole = { text: filled(pattern.text, found.map((one) => one.text)), is_whole: found.every((one) => one.is_whole) };
    if (whole.is_whole) return whole;
    partial ??= whole;
  }
  return partial;
}

/** A pattern that begins with a small letter, at the beginning of a sentence. */
function by_capital(search: Search, english: string, depth: number): Found | null {
  if (!/^[A-Z]/.test(english)) return null;
  const found = by_pattern(search, english.charAt(0).toLowerCase() + english.slice(1), depth);
  return found?.is_whole ? { text: found.text.charAt(0).toUpperCase() + found.text.slice(1), is_whole: true } : null;
}

/** The items of a list. */
function by_pieces(search: Search, english: string, depth: number): Found | null {
  const at = english.indexOf(", ");
  if (at <= 0 || at + 2 === english.length) return null;
  const [first, rest] = [english.slice(0, at), english.slice(at + 2)].map((one) => search_for(search, one, depth));
  return { text: `${first.text}, ${rest.text}`, is_whole: first.is_whole && rest.is_whole };
}

/** Without blanks or brackets around it, or a mark at its end. */
function by_inner(search: Search, english: string, depth: number): Found | null {
  const [, before, inner, behind] = /^([ \n\t]+)(.*?)([ \n\t]*)$/s.exec(english) ?? /^()(.*?)([ \n\t]+)$/s.exec(english) ?? /^(\()(.+)(\))$/s.exec(english) ?? /^()(.*[^.:;,!?])([.:;,!?]{4,})$/s.exec(english) ?? /^()(.+)([.:;,!?])$/s.exec(english) ?? [];
  if (inner === undefined) return null;
  const found = search_for(search, inner, depth);
  return { text: before + found.text + behind, is_whole: found.is_whole };
}

/** What is before the first ". ", "! ", "? ", "; " or ": ", and the rest. */
function by_sentence(search: Search, english: string, depth: number): Found | null {
  const end = /[.!?;:] (?=.)/s.exec(english);
  if (!end) return null;
  const [first, rest] = [english.slice(0, end.index + 1), english.slice(end.index + 1)].map((one) => search_for(search, one, depth));
  return { text: first.text + rest.text, is_whole: first.is_whole && rest.is_whole };
}

function search_for(search: Search, english: string, depth: number): Found {
  const { catalogue, known } = search;
  if (is_quantity(english)) return { text: with_sign(english, catalogue.decimal_sign), is_whole: true };
  const same = exact(catalogue, english);
  if (same !== null) return { text: same, is_whole: true };
  const key = `${depth} ${english}`;
  const before = known.get(key);
  if (before) return before;
  search.left -= 1;
  if (search.left < 0) return { text: english, is_whole: false };
  let best: Found | null = null;
  for (const way of [by_inner, depth < kDeepest ? by_pattern : null, depth < kDeepest ? by_capital : null, by_pieces, by_sentence]) {
    if (best?.is_whole) break;
    const found = way?.(search, english, depth) ?? null;
    if (found && (found.is_whole || !best)) best = found;
  }
  const result = best ?? { text: english, is_whole: false };
  known.set(key, result);
  return result;
}

/** The text itself; else the pattern with the most fixed characters whose places are known too; else its parts. What nothing fits stays English. */
export function translated(catalogue: Catalogue, english: string): string {
  if (english.length > kMostLength) return english;
  return search_for({ catalogue, known: new Map(), left: kMostParts }, english, 0).text;
}
