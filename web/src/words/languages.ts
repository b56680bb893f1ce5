// Languages of the page: a file in this folder each, and one of the same name in data/language. Each is loaded when it is chosen.

import { read_choice, write_choice } from "../lib/choices.ts";
import { best_language, has_server_words, language, set_server_words, set_words, type PageWords, type ServerWords } from "../lib/words.ts";

type Files<T> = Record<string, () => Promise<{ default: T }>>;
const kPage = import.meta.glob("./*.json") as Files<PageWords>;
const kServer = import.meta.glob("../../../data/language/*.json") as Files<ServerWords>;

function of<T>(files: Files<T>, code: string): (() => Promise<{ default: T }>) | undefined {
  return Object.entries(files).find(([path]) => path.endsWith(`/${code}.json`))?.[1];
}

/** English, and the languages that have a file. */
export const kLanguages = ["en", ...Object.keys(kPage).map((path) => path.replace(/^.*\/|\.json$/g, ""))];

/** The language's own name: "Deutsch". */
export function language_name(code: string): string {
  const name = new Intl.DisplayNames([code], { type: "language" }).of(code) ?? code;
  return name.charAt(0).toLocaleUpperCase(code) + name.slice(1);
}

async function use(code: string): Promise<void> {
  set_words(code, code === "en" ? null : (await of(kPage, code)!()).default);
  document.documentElement.lang = code;
}

/** Texts of the simulation, which the public pages do not show: a phone need not load them. */
export async function load_server_words(): Promise<void> {
  const code = language();
  if (code === "en" || has_server_words()) return;
  try {
    const words = (await of(kServer, code)?.())?.default;
    if (words && code === language()) set_server_words(words);
  } catch (error) {
    console.error(error);  // These texts stay English.
  }
}

/** The language that was chosen here, else the browser's. */
export async function start_language(): Promise<void> {
  const chosen = read_choice("trocar-language");
  const code = best_language(chosen ? [chosen] : navigator.languages, kLanguages);
  try {
    await use(code);
  } catch (error) {
    console.error(error);  // The file could not be loaded: English is there.
  }
}

/** Changes the language and tells the page. Without storage it holds until the page is loaded again. */
export async function choose_language(code: string): Promise<void> {
  await use(code);
  write_choice("trocar-language", code);
  document.dispatchEvent(new Event("wordschange"));
}

