// The page's languages: the algorithm of docs/languages.md, and that every text of the sources is there in every language.

import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { afterEach, test } from "node:test";
import { fileURLToPath } from "node:url";
import { filled, make_catalogue, places_of, translated, with_sign } from "../../src/lib/catalogue.ts";
import { clock_text, date_text, duration_text, event_text, fixed, number_text, said_words, with_unit } from "../../src/lib/format.ts";
import { best_language, decimal, language, plural, said, set_server_words, set_words, t, t_nodes, type PageWords } from "../../src/lib/words.ts";
import { source_texts, texts_in, type SourceTexts } from "./source_texts.ts";

const folder = fileURLToPath(new URL("../../../", import.meta.url));
const languages = readdirSync(join(folder, "src", "words")).filter((one) => one.endsWith(".json"));
function read_words(file: string): PageWords {
  return JSON.parse(readFileSync(join(folder, "src", "words", file), "utf8")) as PageWords;
}

const catalogue = make_catalogue(
  {
    "Liver": "Leber",
    "right portal vein": "rechte Pfortader",
    "Needle {0} mm from the target": "Nadel {0} mm vom Ziel",
    "Needle {0}": "Nadel: {0}",
    "the needle went {0} mm into the {1}": "in die Struktur {1} ging die Nadel {0} mm",
    "{0} of {1} shots": "{1} Schüsse, davon {0}",
    "{0} — {1}": "{0} – {1}",
    "Withdraw the needle.": "Ziehen Sie die Nadel zurück.",
    "It is {0} mm deep.": "Sie ist {0} mm tief.",
  },
  ",",
);
const german = (text: string): string => translated(catalogue, text);

test("the cases that the C++ test shares", () => {
  const file = join(folder, "..", "src", "foundation", "language", "test", "cases.json");
  const { texts, cases } = JSON.parse(readFileSync(file, "utf8")) as { texts: Record<string, string>; cases: [string, string][] };
  const shared = make_catalogue(texts, ",");
  for (const [english, expected] of cases) assert.equal(translated(shared, english), expected);
});

test("a whole text, else the pattern with the most fixed characters", () => {
  assert.equal(german("Liver"), "Leber");
  assert.equal(german("Needle 2.5 mm from the target"), "Nadel 2,5 mm vom Ziel");
  assert.equal(german("Needle bent"), "Nadel: bent");
});

test("places keep their numbers, whatever their order is; what stands in them is translated in turn", () => {
  assert.equal(german("the needle went 12.5 mm into the right portal vein"), "in die Struktur rechte Pfortader ging die Nadel 12,5 mm");
  assert.equal(german("2 of 3 shots"), "3 Schüsse, davon 2");
  assert.equal(german("Liver — Needle bent"), "Leber – Nadel: bent");
});

test("no place is empty", () => {
  assert.equal(german("Needle  mm from the target"), "Nadel:  mm from the target");
  assert.equal(german("Needle "), "Needle ");
});

test("each sentence on its own; what nothing fits stays English", () => {
  assert.equal(german("Withdraw the needle. It is 2.5 mm deep. Unknown text 1.5!"), "Ziehen Sie die Nadel zurück. Sie ist 2,5 mm tief. Unknown text 1.5!");
  assert.equal(german("Nothing fits 1.5 here"), "Nothing fits 1.5 here");
  assert.equal(german(""), "");
  assert.equal(german("Withdraw the needle.; Liver: 2.5 mm"), "Ziehen Sie die Nadel zurück.; Leber: 2,5 mm");
});

test("a name at the beginning of a line, in brackets, before a mark, among blanks", () => {
  assert.deepEqual(["Right portal vein", "(Liver)", "Liver!", " Liver\n", "(Unknown)"].map(german), ["Rechte Pfortader", "(Leber)", "Leber!", " Leber\n", "(Unknown)"]);
});

test("a pattern whose places are known goes before one with more characters that leaves English", () => {
  const two = make_catalogue({ "{0} beside the {1}": "{0} neben {1}", "{0} the {1}": "{0} das {1}", "go beside": "gehe neben", liver: "Leber" }, ",");
  assert.equal(translated(two, "go beside the liver"), "gehe neben das Leber");
});

test("numbers with their units get the decimal sign, other texts with numbers do not", () => {
  assert.deepEqual(["1.5", "-0.25", "\u22122.0 mm", "19.5 × 18.5 mm", "12.5\u00a0%", "4.5°", "< 0.001", "–"].map(german), ["1,5", "-0,25", "\u22122,0 mm", "19,5 × 18,5 mm", "12,5\u00a0%", "4,5°", "< 0,001", "–"]);
  for (const other of ["station-1.5", "12", "1.5 and more words", "v1.5"]) assert.equal(german(other), other);
  assert.equal(with_sign("3. 1.5", ","), "3. 1,5");
});

test("hostile texts are texts: braces and markup stay, and long ones end", () => {
  assert.equal(german("Needle {1}{0}"), "Nadel: {1}{0}");
  assert.equal(german("2 of {0} shots"), "{0} Schüsse, davon 2");
  assert.equal(german("Needle <img src=x onerror=alert(1)>"), "Nadel: <img src=x onerror=alert(1)>");
  assert.equal(filled("{0} and {1}", ["{1}", "$&"]), "{1} and $&");
  assert.equal(filled("{0} {7}", ["a"]), "a {7}");
  for (const name of ["__proto__", "constructor", "toString"]) assert.equal(german(name), name);
  const start = performance.now();
  german("Needle ".repeat(5000));
  german(`${"a — ".repeat(900)}b`);
  german("— ".repeat(1500));
  for (const file of languages) {
    const words = read_words(file);
    translated(make_catalogue({ ...words.server, "{0}, {1}": "{0}, {1}", "{0} ({1}": "{0} ({1}", "{0}: {1}": "{0}: {1}" }, ","), "a, b (c — d), e; f: g. ".repeat(150));
  }
  assert.ok(performance.now() - start < 500);
});

test("the first of the wished languages that there is, else English", () => {
  assert.deepEqual([["de-AT", "en"], ["fr", "DE"], ["en-GB", "de"], ["fr"], []].map((one) => best_language(one, ["en", "de"])), ["de", "de", "en", "en", "en"]);
});

afterEach(() => set_words("en", null));

test("without German every text is English; with it numbers and dates follow", () => {
  assert.equal(language(), "en");
  assert.equal(t("{0} of {1}", 1, 2), "1 of 2");
  assert.equal(said("Liver"), "Liver");
  assert.equal(date_text(1_790_000_000), "21 Sept 2026");
  set_words("de", { decimal_sign: ",", texts: { "{0} of {1}": "{0} von {1}", "{0} note": "{0} Notiz", "by {0}!": "von {0}!" }, server: { Liver: "Leber", lesion: "Herd", Enter: "Eintritt" } });
  assert.equal(said("Liver"), "Leber");
  set_server_words({ texts: { Liver: "Leber!" } });
  assert.equal(t("{0} of {1}", 1, 2), "1 von 2");
  assert.equal(t("unknown {0}", 1), "unknown 1");
  assert.equal(plural(1, "{0} note", "{0} notes"), "1 Notiz");
  assert.deepEqual(t_nodes("by {0}!", { a: 1 }), ["von ", { a: 1 }, "!"]);
  assert.equal(said("Liver"), "Leber!");
  assert.equal(said_words("lesion"), "Herd");
  assert.equal(event_text("enter:lesion"), "Eintritt: Herd");
  assert.equal(event_text("enter:other_thing"), "Eintritt: other thing");
  assert.deepEqual([fixed(-1.25, 1), number_text(0.0123), number_text(1234567), with_unit(4.5, "mm"), duration_text(8.31), clock_text(58.24), decimal("0.5")], ["\u22121,3", "0,012", "1,2\u00a0×\u00a010⁶", "4,50\u00a0mm", "8,3\u00a0s", "0:58,2", "0,5"]);
  assert.equal(date_text(1_790_000_000), "21. Sept. 2026");
});

const found = source_texts(join(folder, "src"), [join("lib", "words.ts")]);

test("the scanner finds texts, texts that bypass the dictionary, and texts that are not written at their call", () => {
  const one: SourceTexts = { keys: new Map(), raw: [], hidden: [] };
  texts_in('h("p", { class: "card wide", title: "Some help" }, t("A text"), `${n} of them`); plural(2, "{0} a", b ? "{0} b" : "{0} c"); t(name);', "x.ts", one);
  assert.deepEqual([...one.keys.keys()], ["A text", "{0} a", "{0} b", "{0} c"]);
  assert.deepEqual(one.raw.map((text) => text.replace(/^\S+ /, "")), ["Some help", "`${n} of them`"]);
  assert.equal(one.hidden.length, 1);
});

test("every text of the sources goes through the dictionary", () => {
  assert.ok(found.keys.size > 300);
  assert.deepEqual(found.raw, []);
  assert.deepEqual(found.hidden, []);
});

for (const file of languages) {
  const words = read_words(file);
  test(`${file} has every text of the sources, and no other`, () => {
    assert.deepEqual([...found.keys].filter(([text]) => !(text in words.texts)).map(([text, place]) => `${place} ${text}`), []);
    assert.deepEqual(Object.keys(words.texts).filter((text) => !found.keys.has(text)), []);
  });
  test(`${file} keeps the places, and leaves no text empty`, () => {
    for (const [english, text] of Object.entries({ ...words.texts, ...words.server })) {
      assert.deepEqual([...new Set(places_of(text))].sort(), [...new Set(places_of(english))].sort(), english);
      assert.ok(text.trim() === text && text !== "", english);
    }
  });
  test(`${file}: places of a text of the server are numbered from 0`, () => {
    for (const english of Object.keys(words.server)) assert.deepEqual(places_of(english), places_of(english).map((_, k) => k), english);
  });
  test(`${file}: a text of the server is made by the server`, { skip: !existsSync(join(folder, "..", "src", "service")) }, () => {
    const program = ["service/web", "foundation/signing", "foundation/telemetry", "training/results", "training/cohort", "training/learning", "training/storage"].map((one) => texts_below(join(folder, "..", "src", one))).join("\n");
    // A text is written in pieces: each of its longer words is in one of the program's texts.
    for (const english of Object.keys(words.server)) {
      for (const word of english.replace(/\{\d+\}/g, " ").match(/[\p{L}-]{4,}/gu) ?? []) assert.ok(program.includes(word.toLowerCase()), `${english}: ${word}`);
    }
  });
}

/** What stands in quotation marks in the C++ sources below a folder. */
function texts_below(at: string): string {
  return readdirSync(at, { withFileTypes: true })
    .map((one) => {
      if (one.isDirectory()) return one.name === "test" ? "" : texts_below(join(at, one.name));
      return /\.(cpp|h)$/.test(one.name) ? (readFileSync(join(at, one.name), "utf8").match(/"(?:[^"\\\n]|\\.)*"/g) ?? []).join("\n").toLowerCase() : "";
    })
    .join("\n");
}
