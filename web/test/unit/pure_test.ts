// Pure functions of the page. Known answers worked out by hand.

import assert from "node:assert/strict";
import { readdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { clock_text, duration_text, event_text, fixed, number_text, percent, sentence, state_text, with_unit, words } from "../../src/lib/format.ts";
import { extent_of, index_at, kFront, kSide, project, tissue_stretches, turned } from "../../src/replay/trace.ts";
import type { Point3, Trace } from "../../src/lib/types.ts";
import { plural } from "../../src/lib/words.ts";

test("numbers keep three significant digits and a true minus sign", () => {
  assert.deepEqual([0.01234, 1.234, 12.34, 123.4, 1234.5, 1234567, -17.52, 0, 3, 2.7e-14, -0.00025].map(number_text), ["0.012", "1.23", "12.3", "123", "1\u202f235", "1.2\u00a0×\u00a010⁶", "\u221217.5", "0", "3", "0", "\u22122.5\u00a0×\u00a010⁻⁴"]);
  assert.equal(number_text(null), "–");
  assert.equal(number_text(Number.NaN), "–");
  assert.equal(fixed(-0.04, 1), "0.0");
});

test("units follow their numbers, degrees without a space, the unit 1 not at all", () => {
  assert.equal(with_unit(4.5, "mm"), "4.50\u00a0mm");
  assert.equal(with_unit(4.5, "deg"), "4.50°");
  assert.equal(with_unit(2, "1"), "2");
  assert.equal(with_unit(null, "mm"), "–");
});

test("times are read as clocks", () => {
  assert.equal(clock_text(58.24), "0:58.2");
  assert.equal(clock_text(60), "1:00.0");
  assert.equal(clock_text(59.999), "0:59.9");
  assert.equal(duration_text(75.4), "1:15\u00a0min");
  assert.equal(duration_text(8.31), "8.3\u00a0s");
});

test("words, plurals and shares", () => {
  assert.equal(words("not_scored"), "Not scored");
  assert.equal(words("liver-biopsy"), "Liver biopsy");
  assert.equal(words("csf"), "CSF");
  assert.equal(words(null), "–");
  assert.equal(event_text("enter:supraspinous_ligament"), "Enter: supraspinous ligament");
  assert.equal(event_text("shot"), "Shot");
  assert.equal(sentence("the needle went in"), "The needle went in.");
  assert.equal(sentence("Done!"), "Done!");
  assert.equal(sentence(" "), "");
  assert.equal(state_text("never-began"), "The needle never entered the body");
  assert.equal(state_text("of_a_newer_server"), "Of a newer server");
  assert.equal(plural(1, "{0} person", "{0} people"), "1 person");
  assert.equal(plural(0, "{0} answer of {1}", "{0} answers of {1}", 3), "0 answers of 3");
  assert.equal(percent(1, 3), "33\u00a0%");
  assert.equal(percent(0, 0), "–");
});

test("the moment of a time is the last one that is not after it", () => {
  const times = [0, 0.04, 0.08, 0.2];
  assert.deepEqual([-1, 0, 0.039, 0.04, 0.1, 0.2, 9].map((one) => index_at(times, one)), [0, 0, 0, 1, 2, 3, 3]);
});

test("projections show left on the right, the head up and the front on the left", () => {
  const left: Point3 = [1, 0, 0];
  const head: Point3 = [0, 0, 1];
  const back: Point3 = [0, 1, 0];
  assert.deepEqual(project(kFront, [0, 0, 0], left), [1, 0]);
  assert.deepEqual(project(kFront, [0, 0, 0], head), [0, -1]);
  assert.deepEqual(project(kSide, [0, 0, 0], back), [1, 0]);
  assert.deepEqual(project(kSide, [0, 0, 0], head), [0, -1]);
});

test("a turned view is a rotation, begins at the front, passes the side and ends above", () => {
  const near = (a: readonly number[], b: readonly number[]): void => a.forEach((one, k) => assert.ok(Math.abs(one - b[k]) < 1e-12, `${a} is not ${b}`));
  turned(0, 0).forEach((row, k) => near(row, kFront[k]));
  turned(90, 0).forEach((row, k) => near(row, kSide[k]));
  near(turned(0, 90)[2], [0, 0, -1]);  // from above: the viewer looks towards the feet
  const [a, b, c] = turned(37, -21);
  const dot = (u: Point3, v: Point3): number => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  near([dot(a, a), dot(b, b), dot(c, c), dot(a, b), dot(b, c), dot(a, c)], [1, 1, 1, 0, 0, 0]);
});

test("the extent has the middle of the points and never vanishes", () => {
  const extent = extent_of([[0, 0, 0], [40, 20, -60]]);
  assert.deepEqual(extent.centre, [20, 10, -30]);
  assert.equal(extent.half_across_mm, 20);
  assert.equal(extent.half_along_mm, 30);
  assert.ok(Math.abs(extent.radius_mm - Math.hypot(20, 10, 30)) < 1e-12);
  assert.equal(extent_of([[5, 5, 5]]).half_along_mm, 10);
});

test("stretches of one tissue are joined, gaps and changes divide them", () => {
  const trace = { rate_hz: 10, time_s: [0, 0.1, 0.2, 0.3, 0.4, 0.5], depth_mm: [0, 1, 2, 3, 4, 5], tissue: [2, 0, 0, 1, null, 1], tissues: ["fat", "liver", "air"] } as unknown as Trace;
  const found = tissue_stretches(trace).map((one) => [one.tissue, Number(one.start_s.toFixed(3)), Number(one.end_s.toFixed(3))]);
  assert.deepEqual(found, [["fat", 0.1, 0.3], ["liver", 0.3, 0.4], ["liver", 0.5, 0.6]]);
});

test("no source writes HTML, and no file has more than 450 lines", () => {
  const source = fileURLToPath(new URL("../../../src", import.meta.url));
  const files = (folder: string): string[] => readdirSync(folder).flatMap((one) => (statSync(join(folder, one)).isDirectory() ? files(join(folder, one)) : [join(folder, one)]));
  const all = files(source);
  assert.ok(all.length > 20);
  for (const file of all) {
    const text = readFileSync(file, "utf8");
    assert.doesNotMatch(text, /innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|createContextualFragment/, file);
    assert.ok(file.endsWith(".json") || text.split("\n").length <= 450, file);
  }
});
