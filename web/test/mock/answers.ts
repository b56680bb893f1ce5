// The answers of the interface, computed from the made-up data.

import { kCourses, kTasks, make_attempts, make_people, type MockAttempt, type MockPerson } from "./cohort.ts";
import { kMetrics, metric_value, quantile, separation } from "./metrics.ts";
import { Random } from "./random.ts";
import { make_trace } from "./trace.ts";

const counts_text = (all: MockAttempt[]): string => {
  const counted = all.filter((one) => one.passed !== null);
  const lost = all.length - counted.length;
  return `${counted.length} attempts counted (${counted.filter((one) => one.score === null).length} ended without a result)${lost ? `, ${lost} left out: ${lost} ${lost === 1 ? "was lost to a crash" : "were lost to crashes"}` : ""}`;
};
const mean = (values: number[]): number | null => (values.length ? values.reduce((a, b) => a + b, 0) / values.length : null);
const kParts: [string, string, (lost: number) => string, number][] = [
  ["target", "Distance to the target", (lost) => `${(8 * lost).toFixed(1)} mm`, 15], ["core", "Target tissue in the cores", (lost) => `${(18 * (1 - lost)).toFixed(1)} mm`, 25],
  ["risk", "Structures harmed", (lost) => (lost > 0.3 ? "1" : "0"), 20], ["access", "Missing safety margin to structures at risk", (lost) => `${(6 * (1 - lost)).toFixed(1)} mm`, 15],
  ["visibility", "Tip visible while advancing", (lost) => `${(100 * (1 - lost)).toFixed(0)} %`, 5], ["comfort", "Pain events", (lost) => String(Math.round(3 * lost)), 5],
  ["length", "Needle travel inside the body", (lost) => `${(70 + 30 * lost).toFixed(0)} mm`, 5], ["time", "Time", (lost) => `${(40 + 80 * lost).toFixed(0)} s`, 5], ["passes", "Extra organ punctures and shots", (lost) => String(1 + Math.round(3 * lost)), 5],
];

export class MockResults {
  readonly people: MockPerson[];
  readonly attempts: MockAttempt[];
  readonly courses = kCourses.map((one) => ({ ...one }));
  constructor() {
    const random = new Random(23);
    this.people = make_people(random);
    this.attempts = make_attempts(random, this.people);
  }

  private of(person: string, task: string): MockAttempt[] {
    return this.attempts.filter((one) => one.person === person && (!task || one.task === task));
  }

  private person_answer(person: MockPerson): Record<string, unknown> {
    const tasks: Record<string, unknown> = {};
    for (const task of kTasks) {
      const every = this.of(person.id, task.id);
      const all = every.filter((one) => one.passed !== null);
      if (every.length === 0) continue;
      const scores = all.flatMap((one) => (one.score === null ? [] : [one.score]));
      tasks[task.id] = {
        attempts: all.length, scored: scores.length, passed: all.filter((one) => one.passed).length, last_score: scores[scores.length - 1] ?? null,
        best_score: scores.length ? Math.max(...scores) : null, recent_mean: mean(scores.slice(-5)), last_s: every[every.length - 1].started_s,
        unscored: all.length - scores.length, never_began: 0, lost: every.length - all.length, running: 0, counts_text: counts_text(every),
      };
    }
    const { id, name, group, course, simulated, has_pin = false } = person;
    return { id, name, group, course, simulated, has_pin, tasks };
  }

  overview(course: string | null): unknown {
    return { tasks: kTasks, courses: this.courses, people: this.people.filter((one) => !course || one.course === course).map((one) => this.person_answer(one)) };
  }
  person(id: string): unknown {
    const person = this.people.find((one) => one.id === id);
    return person ? { person: this.person_answer(person), tasks: kTasks, courses: this.courses } : null;
  }
  find_person(id: string): MockPerson | undefined {
    return this.people.find((one) => one.id === id);
  }
  /** A course of this name, made if there is none; null without a name. */
  course_of(name: string): string | null {
    if (!name) return null;
    if (!this.courses.some((one) => one.id === name)) this.courses.push({ id: name, name });
    return name;
  }
  rename_course(name: string, new_name: string): void {
    const course = this.courses.find((one) => one.id === name);
    if (course) course.id = course.name = new_name;
    for (const person of this.people) if (person.course === name) person.course = new_name;
  }
  find_attempt(id: string): MockAttempt | undefined {
    return this.attempts.find((one) => one.id === id);
  }
  delete_note(id: string): void {
    for (const one of this.attempts) one.notes = one.notes.filter((note) => note.id !== id);
  }
  delete_person(id: string): void {
    this.people.splice(this.people.findIndex((one) => one.id === id), 1);
  }
  list(person: string, task: string, before: number, limit: number): unknown {
    const all = this.of(person, task).filter((one) => one.sequence < before).reverse();
    const page = all.slice(0, limit);
    return { attempts: page.map((one) => ({ ...this.attempt_answer(one), ...this.reasons(one), notes: one.notes.length })), next: all.length > limit ? page[page.length - 1].sequence : null };
  }
  private attempt_answer(one: MockAttempt): Record<string, unknown> {
    const { id, sequence, task, patient, difficulty, level, started_s, state, score, passed, duration_s, station } = one;
    return { id, sequence, task, patient, difficulty, level, started_s, state, score, passed, duration_s, station };
  }

  private reasons(one: MockAttempt): { not_scored: string | null; fails: string[] } {
    const is_failed = one.passed === false && one.score !== null;
    const fails = !is_failed ? [] : one.score! < 70 ? ["the score is below the pass mark of 70"] : ["the needle went 12 mm into the right portal vein"];
    return { not_scored: one.score === null ? "the gun was not fired" : null, fails };
  }

  curve(person: string, task: string): unknown {
    const all = this.of(person, task).filter((one) => one.passed !== null);
    const recent: number[] = [];
    const points = all.map((one, k) => {
      if (one.score !== null) recent.push(one.score);
      return { n: k + 1, attempt: one.id, started_s: one.started_s, score: one.score, passed: one.passed, patient: one.patient, difficulty: one.difficulty, moving_mean: mean(recent.slice(-5)) };
    });
    let sum = 0;
    const [upper, lower, pass_step] = [2.2, -2.2, 0.29];
    const values = points.map((one) => {
      if (sum >= upper || sum <= lower) sum = 0;
      sum += one.passed === false ? 1 - pass_step : one.passed ? -pass_step : 0;
      return sum;
    });
    const experts = this.people.filter((one) => one.group === "expert").flatMap((one) => this.of(one.id, task).flatMap((a) => a.score ?? []));
    const sorted = [...experts].sort((a, b) => a - b);
    const peers = this.people.filter((one) => one.group === "trainee" && one.id !== person).map((one) => this.of(one.id, task));
    const mean_by_attempt = points.map((_, k) => mean(peers.flatMap((one) => one[k]?.score ?? [])));
    return { points, counts_text: counts_text(this.of(person, task)), cusum: { values, upper, lower, acceptable: 0.2, unacceptable: 0.4 }, experts: { n: sorted.length, mean: mean(sorted), low: quantile(sorted, 0.05), high: quantile(sorted, 0.95) }, peers: { n: peers.filter((one) => one.length).length, mean_by_attempt } };
  }

  private value_of(attempt: MockAttempt, name: string): number | null {
    if (attempt.score === null) return null;
    if (name === "score") return attempt.score;
    const index = kMetrics.findIndex((one) => one.name === name);
    return metric_value(kMetrics[index], attempt.skill, new Random(attempt.sequence * 131 + index));
  }
  /** One mean a person. */
  private values(task: string, name: string, keep: (person: MockPerson) => boolean, is_wanted: (attempt: MockAttempt) => boolean = () => true): number[] {
    const means = this.people.filter(keep).map((person) => mean(this.of(person.id, task).filter(is_wanted).flatMap((one) => this.value_of(one, name) ?? [])));
    return means.flatMap((one) => one ?? []).sort((a, b) => a - b);
  }
  metrics(): unknown {
    return { metrics: kMetrics.map(({ name, title, unit, better }) => ({ name, title, unit, better })) };
  }
  distribution(name: string, task: string, course: string): unknown {
    const metric = kMetrics.find((one) => one.name === name);
    if (!metric) return null;
    const in_course = (one: MockPerson): boolean => !course || one.course === course || one.group === "expert";
    const kinds = [["expert", false], ["expert", true], ["trainee", false], ["trainee", true]] as const;
    const lists = kinds.map(([group, simulated]) => this.values(task, name, (one) => one.group === group && one.simulated === simulated && in_course(one)));
    const every = lists.flat().sort((a, b) => a - b);
    const low = every[0] ?? 0;
    const high = every[every.length - 1] ?? 1;
    const bins = 20;
    const edges = Array.from({ length: bins + 1 }, (_, k) => low + ((high - low) * k) / bins);
    const groups = kinds.map(([group, simulated], k) => {
      const counts = new Array<number>(bins).fill(0);
      for (const value of lists[k]) counts[Math.min(bins - 1, Math.floor(((value - low) / (high - low || 1)) * bins))] += 1;
      const q = (share: number): number | null => quantile(lists[k], share);
      return { group, simulated, n: lists[k].length, attempts: 20 * lists[k].length, counts, min: q(0), q1: q(0.25), median: q(0.5), q3: q(0.75), max: q(1) };
    });
    const value = separation([...lists[0], ...lists[1]], [...lists[2], ...lists[3]], metric.better === "lower");
    const { title, unit, better } = metric;
    return { name, title, unit, better, edges, groups, auc: { value, low: Math.max(0, value - 0.06), high: Math.min(1, value + 0.05) } };
  }

  attempt(id: string): unknown {
    const one = this.attempts.find((attempt) => attempt.id === id);
    if (!one) return null;
    const person = this.people.find((who) => who.id === one.person)!;
    const random = new Random(one.sequence);
    const share = (one.score ?? 0) / 100;
    const parts = one.score === null ? [] : kParts.map(([name, title, text, max_points]) => {
      const points = Math.max(0, Math.min(max_points, max_points * (share + random.normal(0, 0.15))));
      return { name, title, value_text: text(1 - points / max_points), points, max_points };
    });
    const metrics = kMetrics.slice(1).map(({ name, title, unit, better }) => {
      const values = this.values(one.task, name, (who) => who.group === "expert");
      return { name, title, unit, better, value: this.value_of(one, name), expert_median: quantile(values, 0.5), expert_q1: quantile(values, 0.25), expert_q3: quantile(values, 0.75) };
    });
    const hints = [
      { text: "The tip was in the image during 62 % of the advance: stop when you lose it, and move the transducer until you see it again.", at_s: 0.5 * one.duration_s },
      { text: "The needle was redirected twice inside the liver: withdraw it to the capsule before you change its direction.", at_s: 0.62 * one.duration_s },
      { text: "Give the local anaesthetic before the skin is punctured.", at_s: null },
    ].slice(0, one.passed ? 1 : 3);
    return { attempt: { ...this.attempt_answer(one), person: { id: person.id, name: person.name, simulated: person.simulated }, ...this.reasons(one), hints }, notes: one.notes, parts, metrics };
  }
  trace(id: string): unknown {
    const one = this.attempts.find((attempt) => attempt.id === id);
    if (!one || one.state !== "finished") return null;
    return { ...make_trace(one.sequence, one.skill, Math.max(30, one.duration_s)), expert: make_trace(7, 0.96, 55) };
  }

  private choices(task: string): { patients: string[]; levels: string[] } {
    const all = this.attempts.filter((one) => one.task === task);
    return { patients: [...new Set(all.map((one) => one.patient))].sort(), levels: [...new Set(all.map((one) => one.level))].sort() };
  }
  validity(task: string, patient: string, level: string): unknown {
    const is_wanted = (one: MockAttempt): boolean => (!patient || one.patient === patient) && (!level || one.level === level);
    const rows = kMetrics.map((metric) => {
      const experts = this.values(task, metric.name, (one) => one.group === "expert", is_wanted);
      const novices = this.values(task, metric.name, (one) => one.group === "trainee", is_wanted);
      const { name, title, unit, better } = metric;
      const enough = experts.length >= 3 && novices.length >= 3;
      const auc = separation(experts, novices, better === "lower");
      return { name, title, unit, better, n_expert: experts.length, n_novice: novices.length, expert_median: quantile(experts, 0.5), novice_median: quantile(novices, 0.5), auc: enough ? auc : null, low: enough ? Math.max(0, auc - 0.07) : null, high: enough ? Math.min(1, auc + 0.05) : null, p: enough ? Math.max(1e-5, (1 - auc) ** 3) : null, discriminates: enough ? auc > 0.7 : null };
    });
    const judged = rows.filter((one) => one.discriminates !== null);
    const count = judged.filter((one) => one.discriminates).length;
    const few = task === "ptcd";
    return {
      task, ...this.choices(task), counts_text: counts_text(this.attempts.filter((one) => one.task === task && is_wanted(one))), experts: 3, novices: 23, expert_attempts: 9, novice_attempts: 69, expert_unscored: 0, novice_unscored: 3, simulated: true, passed: { ...rows[0], expert_median: 0.9, novice_median: 0.4 }, metrics: rows, discriminating: judged.length ? { share: count / judged.length, count, of: judged.length, uncorrected: Math.min(judged.length, count + 2), note: "" } : null,
      alpha: few ? null : { value: 0.81, items: 9, n: 640 }, pass_mark: few ? null : { value: 68.4, false_passes: 4, false_fails: 0, experts: 3, novices: 23 }, reason: few ? "fewer than 30 scored attempts" : null,
    };
  }
  proficiency(task: string, patient: string, level: string): unknown {
    const kinds = [["trainee", false], ["trainee", true], ["expert", false], ["expert", true]] as const;
    const groups = kinds.flatMap(([group, simulated]) => {
      const members = this.people.filter((one) => one.group === group && one.simulated === simulated);
      const every = members.map((one) => ({ one, all: this.of(one.id, task).filter((a) => (!patient || a.patient === patient) && (!level || a.level === level)) })).filter(({ all }) => all.some((a) => a.passed !== null));
      const people = every.map(({ one, all }) => {
        const counted = all.filter((a) => a.passed !== null);
        const at = counted.findIndex((_, k) => k >= 2 && counted.slice(k - 2, k + 1).every((a) => a.passed && a.score! >= 80));
        return { id: one.id, name: one.name, attempts: counted.length, passed: counted.filter((a) => a.passed).length, trials: at < 0 ? null : at + 1, practice_s: all.reduce((sum, a) => sum + a.duration_s, 0), first_pass_share: one.skill, time_to_target_s: 20 - 10 * one.skill, instructor_min: simulated ? null : 30 };
      });
      if (people.length === 0) return [];
      const known = people.flatMap((one) => one.trials ?? []).sort((a, b) => a - b);
      const practice_s = people.reduce((sum, one) => sum + one.practice_s, 0);
      return [{ group, simulated, counts_text: counts_text(every.flatMap(({ all }) => all)), people_count: people.length, proficient: known.length, not_yet: people.length - known.length, median: 2 * known.length > people.length ? known[Math.floor(people.length / 2)] : null, low: known[0] ?? null, high: null, curve: [], practice_s, instructor: simulated ? "none entered (trocar results taught); 20 min of needle time were recorded, the most that an instructor can have watched" : `${30 * people.length} min for ${people.length} ${people.length === 1 ? "person" : "people"}, 30 min each on average`, instructor_min: simulated ? null : 30 * people.length, first_pass_share: 0.5, time_to_target_s: 12, people }];
    });
    return { task, score: 80, passes_in_a_row: 3, ...this.choices(task), groups };
  }
  csv(): string {
    return ["attempt,person,task,score", ...this.attempts.slice(0, 50).map((one) => `${one.id},"'${one.person}",${one.task},${one.score ?? ""}`)].join("\r\n");
  }
}
