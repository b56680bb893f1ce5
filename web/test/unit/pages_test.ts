// Decisions of the pages: order of tables, filters, checks before a request.

import assert from "node:assert/strict";
import { test } from "node:test";
import { compared, cusum_by_point, cusum_verdict } from "../../src/lib/judgement.ts";
import type { CurvePoint, MetricValue, Person } from "../../src/lib/types.ts";
import { path_with } from "../../src/lib/api.ts";
import { password_problem } from "../../src/pages/account.ts";
import { counted_text, matches, total } from "../../src/pages/cohort.ts";
import { moved, problem_of } from "../../src/pages/form_editor.ts";
import { safe_path } from "../../src/pages/login.ts";
import { limits_text } from "../../src/pages/proficiency.ts";
import { missing_items } from "../../src/pages/questionnaire.ts";
import { nice_ticks } from "../../src/plots/histogram.ts";
import { compare_keys, sorted_rows } from "../../src/ui/table.ts";

const person = (changes: Partial<Person>): Person => ({ id: "1", name: "Amara Osei", group: "trainee", course: "c1", simulated: false, tasks: {}, ...changes });

test("missing values are last in both directions, texts are ordered by number", () => {
  assert.ok(compare_keys(null, 3, false) > 0);
  assert.ok(compare_keys(null, 3, true) > 0);
  assert.equal(compare_keys(null, null, true), 0);
  assert.ok(compare_keys("novice 2", "novice 10", false) < 0);
  const columns = [{ name: "n", title: "n", key: (one: number | null) => one, cell: String }];
  assert.deepEqual(sorted_rows([2, null, 10, 1], columns, { column: "n", is_descending: true }), [10, 2, 1, null]);
  assert.deepEqual(sorted_rows([2, 1], columns, { column: "unknown", is_descending: false }), [2, 1]);
});

test("filters of the cohort", () => {
  const all = { search: "", course: "", group: "" };
  assert.ok(matches(person({}), { ...all, search: " osei " }));
  assert.ok(!matches(person({}), { ...all, search: "x" }));
  assert.ok(!matches(person({ course: null }), { ...all, course: "c1" }));
  assert.ok(matches(person({ simulated: true }), { ...all, group: "simulated" }));
  assert.ok(!matches(person({ simulated: true }), { ...all, group: "people" }));
  assert.ok(!matches(person({}), { ...all, group: "expert" }));
});

test("totals of a person add up all tasks", () => {
  const result = (attempts: number, last_s: number | null) => ({ attempts, scored: attempts - 1, passed: 1, last_score: 1, best_score: 2, recent_mean: 1, last_s, unscored: 1, never_began: 2, lost: 1, running: 0 });
  assert.deepEqual(total(person({ tasks: { a: result(3, 50), b: result(2, null) } })), { attempts: 5, passed: 2, unscored: 2, never_began: 4, lost: 2, running: 0, last_s: 50 });
  assert.deepEqual(total(person({})), { attempts: 0, passed: 0, unscored: 0, never_began: 0, lost: 0, running: 0, last_s: null });
});

test("what was counted and left out is said", () => {
  const none = { attempts: 0, unscored: 0, never_began: 0, lost: 0, running: 0 };
  assert.equal(counted_text([]), "0 attempts counted");
  assert.equal(counted_text([{ ...none, attempts: 1 }]), "1 attempt counted");
  assert.equal(counted_text([{ ...none, attempts: 20, unscored: 16, lost: 1 }, { ...none, attempts: 4, never_began: 2 }]), "24 attempts counted (16 ended without a result), 3 left out: 2 never began, 1 was lost to a crash");
});

test("a median that is not reached has no limits, an open limit is said", () => {
  assert.equal(limits_text({ median: 7, low: 5, high: null }), " (95 % 5 to open)");
  assert.equal(limits_text({ median: null, low: 5, high: null }), "");
});

test("the last limit that the CUSUM reached decides", () => {
  assert.match(cusum_verdict([], 2, -2), /no attempts yet/);
  assert.match(cusum_verdict([0.7, 1.4, null], 2, -2), /between the limits/);
  assert.match(cusum_verdict([0.7, 1.4, 2.1, -0.3], 2, -2), /Attempt 3 reached the upper limit/);
  assert.match(cusum_verdict([2.1, -0.3, -2], 2, -2), /Attempt 3 reached the lower limit/);
});

test("CUSUM values without those of unscored attempts find their points", () => {
  const point = (passed: boolean | null): CurvePoint => ({ n: 1, attempt: "", started_s: 0, score: null, passed, patient: "", difficulty: null, moving_mean: null });
  assert.deepEqual(cusum_by_point([point(true), point(null), point(false)], [-0.3, 0.4]), [-0.3, null, 0.4]);
  assert.deepEqual(cusum_by_point([point(true), point(null)], [-0.3, -0.3]), [-0.3, -0.3]);
});

test("a value outside of the experts' quartiles is worse, better or only different", () => {
  const metric = (value: number | null, better: MetricValue["better"]): MetricValue => ({ name: "m", title: "M", unit: "1", better, value, expert_q1: 2, expert_median: 3, expert_q3: 4 });
  assert.equal(compared(metric(4, "lower")).tone, "good");
  assert.equal(compared(metric(5, "lower")).tone, "bad");
  assert.equal(compared(metric(1, "lower")).text, "Better than most experts");
  assert.equal(compared(metric(1, "higher")).tone, "bad");
  assert.equal(compared(metric(5, "neither")).tone, "plain");
  assert.equal(compared(metric(null, "lower")).text, "No comparison");
});

test("the login leads only to paths of this server", () => {
  assert.equal(safe_path("/people/1?task=a"), "/people/1?task=a");
  for (const bad of [null, "", "https://evil.example", "//evil.example", "/\\evil.example", "javascript:alert(1)", "/login?next=/login"]) assert.equal(safe_path(bad), "/", String(bad));
});

test("passwords are checked before they are sent", () => {
  assert.match(password_problem("short", "a")!, /at least 12/);
  assert.equal(password_problem("ääääääääääää", "a"), null);  // 12 characters, 24 bytes
  assert.match(password_problem("x".repeat(129), "a")!, /at most 128/);
  assert.match(password_problem("Administrator", " administrator ")!, /not be the name/);
});

test("the editor names the first item without a text and moves items within the list", () => {
  const item = (text: string) => ({ kind: "scale" as const, text, is_required: true });
  assert.equal(problem_of({ title: " ", intro: "", items: [item("a")] }), "Enter a title.");
  assert.equal(problem_of({ title: "t", intro: "", items: [] }), "Add an item.");
  assert.match(problem_of({ title: "t", intro: "", items: [item("a"), item(" ")] })!, /item 2/);
  assert.equal(problem_of({ title: "t", intro: "", items: [item("a")] }), null);
  assert.deepEqual(moved([1, 2, 3], 0, 1), [2, 1, 3]);
  assert.deepEqual(moved([1, 2, 3], 0, -1), [1, 2, 3]);
  assert.deepEqual(moved([1, 2, 3], 2, 1), [1, 2, 3]);
});

test("only required items without an answer are missing", () => {
  const items = [{ id: 7, kind: "scale" as const, text: "a", is_required: true }, { id: 8, kind: "text" as const, text: "b", is_required: false }, { id: 9, kind: "scale" as const, text: "c", is_required: true }];
  assert.deepEqual(missing_items(items, { 9: 1 }), ["7"]);
});

test("ticks are 1, 2 or 5 times a power of ten inside the range", () => {
  assert.deepEqual(nice_ticks(0.9, 17, 9), [2, 4, 6, 8, 10, 12, 14, 16]);
  assert.deepEqual(nice_ticks(-0.3, 0.3, 3), [-0.2, 0, 0.2]);
  assert.deepEqual(nice_ticks(5, 5, 3), [5]);
});

test("empty parts of a query are left out and texts are encoded", () => {
  assert.equal(path_with("/api/x", { task: "", course: null, before: 0, name: "a&b" }), "/api/x?before=0&name=a%26b");
  assert.equal(path_with("/api/x", { task: undefined }), "/api/x");
});
