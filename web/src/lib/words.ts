// The page's language: what people read goes through t(), plural() or said(). English is the source, and what stays if German is missing.

import { filled, make_catalogue, translated, with_sign, type Catalogue } from "./catalogue.ts";

/** The file of a language in src/words. */
export interface PageWords {
  /** Between whole digits and decimals. */
  decimal_sign: string;
  /** Texts of the page. */
  texts: Record<string, string>;
  /** Texts of the server that data/language does not have. */
  server: Record<string, string>;
}
/** A file of data/language: texts of the simulation, which the server sends in English. */
export interface ServerWords {
  texts: Record<string, string>;
}

interface State {
  code: string;
  words: PageWords | null;
  page: Map<string, string>;
  server: Catalogue | null;
  has_server_words: boolean;
}
const state: State = { code: "en", words: null, page: new Map(), server: null, has_server_words: false };

/** English without `words`. Texts of the simulation may follow. */
export function set_words(code: string, words: PageWords | null): void {
  state.code = code;
  state.words = words;
  state.page = new Map(Object.entries(words?.texts ?? {}));
  state.server = words && make_catalogue(words.server, words.decimal_sign);
  state.has_server_words = false;
}

/** Of a text that both have, that of data/language is taken. */
export function set_server_words({ texts }: ServerWords): void {
  if (!state.words) return;
  state.server = make_catalogue({ ...state.words.server, ...texts }, state.words.decimal_sign);
  state.has_server_words = true;
}

export function has_server_words(): boolean {
  return state.has_server_words;
}

/** The first of the wished languages ("de-AT", "en") that there is; English if there is none. */
export function best_language(wished: readonly string[], known: readonly string[]): string {
  return wished.map((one) => one.toLowerCase().split("-")[0]).find((one) => known.includes(one)) ?? "en";
}

/** "en", "de": also for the order of names. */
export function language(): string {
  return state.code;
}

/** A text of the page with values in its places {0}, {1}. The values are what people read already: see fixed(), said(). */
export function t(text: string, ...values: (string | number)[]): string {
  return filled(state.page.get(text) ?? text, values);
}

/** `one` or `many` by the count, which is the place {0}; further values are {1}, {2}. */
export function plural(count: number, one: string, many: string, ...values: (string | number)[]): string {
  return t(count === 1 ? one : many, count, ...values);
}

/** A text with elements in its places, a link for instance. */
export function t_nodes<Node>(text: string, ...nodes: Node[]): (string | Node)[] {
  return (state.page.get(text) ?? text).split(/\{(\d+)\}/).map((part, k) => (k % 2 === 0 ? part : nodes[Number(part)]));
}

/** A text that the server sent in English. */
export function said(text: string): string {
  return state.server ? translated(state.server, text) : text;
}

/** A number's text with the language's decimal sign. */
export function decimal(text: string): string {
  return state.words ? with_sign(text, state.words.decimal_sign) : text;
}
