// Decisions of the pages: order of tables, filters, checks before a request.

import assert from "node:assert/strict";
import { test } from "node:test";
import { compared, cusum_by_point, cusum_verdict, separation_strength } from "../../src/lib/judgement.ts";
import type { CurvePoint, MetricValue, Person } from "../../src/lib/types.ts";
import { path_with } from "../../src/lib/api.ts";
import { password_problem } from "../../src/pages/account.ts";
import { counted_text, matches, total } from "../../src/pages/cohort.ts";
import { moved, problem_of } from "../../src/pages/form_editor.ts";
import { course_rows, numbers_of, quartiles_of, score_bins, trainees_of } from "../../src/manage/course_numbers.ts";
import { pin_problem } from "../../src/manage/people.ts";
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
  assert.equal(limits_text({ median: 7, low: 5, high: null }), "95 % interval: at least 5.");
  assert.equal(limits_text({ median: 7, low: null, high: 9 }), "95 % interval: at most 9.");
  assert.equal(limits_text({ median: 7, low: 5, high: 9 }), "95 % interval: 5 to 9.");
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

test("a metric without a better direction separates by the distance of its AUC from 0.5", () => {
  assert.equal(separation_strength({ auc: 0.05, better: "neither" }), 0.95);
  assert.equal(separation_strength({ auc: 0.05, better: "lower" }), 0.05);
  assert.equal(separation_strength({ auc: null, better: "neither" }), null);
});

test("a PIN has 4 to 12 digits", () => {
  for (const good of ["0000", "123456789012"]) assert.equal(pin_problem(good), null);
  for (const bad of ["", "123", "1234567890123", "12a4", " 1234", "١٢٣٤"]) assert.match(pin_problem(bad)!, /4 to 12 digits/);
});

const result = (attempts: number, passed: number, recent_mean: number | null, last_s: number) => ({ attempts, scored: attempts, passed, last_score: 1, best_score: 2, recent_mean, last_s, unscored: 0, never_began: 0, lost: 0, running: 0 });

test("a course has the numbers of its real trainees, each counted once in the scores", () => {
  const people = [
    person({ id: "1", tasks: { a: result(4, 2, 60, 100), b: result(2, 1, 80, 300) } }),
    person({ id: "2", tasks: { a: result(4, 0, 40, 200) } }),
    person({ id: "3" }),
    person({ id: "4", group: "expert", tasks: { a: result(9, 9, 99, 900) } }),
    person({ id: "5", simulated: true, tasks: { a: result(9, 9, 99, 900) } }),
    person({ id: "6", course: "c2", simulated: true, tasks: { a: result(5, 1, 30, 50) } }),
    person({ id: "7", course: null }),
  ];
  const { people: members, is_simulated } = trainees_of(people, "c1");
  assert.equal(is_simulated, false);
  assert.deepEqual(members.map((one) => one.id), ["1", "2", "3"]);
  assert.deepEqual(numbers_of(members, ""), { people: 3, practised: 2, with_pass: 1, attempts: 10, passed: 3, scores: [40, 70], last_s: 300 });
  assert.deepEqual(numbers_of(members, "b"), { people: 3, practised: 1, with_pass: 1, attempts: 2, passed: 1, scores: [80], last_s: 300 });
  assert.deepEqual(numbers_of([], ""), { people: 0, practised: 0, with_pass: 0, attempts: 0, passed: 0, scores: [], last_s: null });
  const rows = course_rows({ tasks: [], courses: [{ id: "c1", name: "One" }, { id: "c2", name: "Two" }, { id: "c3", name: "Empty" }], people }, "");
  assert.deepEqual(rows.map((one) => [one.name, one.is_simulated, one.numbers.people]), [["One", false, 3], ["Two", true, 1], ["Empty", false, 0], ["Without a course", false, 1]]);
});

test("quartiles lie linearly between the values, bins have their upper end in the last", () => {
  assert.deepEqual(quartiles_of([10, 20, 30, 50]), { min: 10, q1: 17.5, median: 25, q3: 35, max: 50 });
  assert.deepEqual(quartiles_of([7]), { min: 7, q1: 7, median: 7, q3: 7, max: 7 });
  assert.equal(quartiles_of([]), null);
  assert.deepEqual(score_bins([0, 9.9, 10, 95, 100]), [2, 1, 0, 0, 0, 0, 0, 0, 0, 2]);
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
  assert.equal(problem_of({ title: "t", intro: "", items: [] }), "Add a statement or a question.");
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
