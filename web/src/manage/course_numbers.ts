// Numbers of a course from the cohort's overview. A person counts once, with the mean of the last five scores.

import type { Overview, Person, TaskResult } from "../lib/types.ts";
import { t } from "../lib/words.ts";

export interface Quartiles {
  min: number;
  q1: number;
  median: number;
  q3: number;
  max: number;
}
export interface CourseNumbers {
  /** Trainees of the course. */
  people: number;
  /** Of them, with attempts that count. */
  practised: number;
  /** Of them, with a passed attempt. */
  with_pass: number;
  attempts: number;
  passed: number;
  /** One a person with a score, in ascending order. */
  scores: number[];
  last_s: number | null;
}

/** Linear between the values, as in the server's quartiles. */
export function quartiles_of(sorted: number[]): Quartiles | null {
  if (sorted.length === 0) return null;
  const at = (share: number): number => {
    const place = share * (sorted.length - 1);
    const low = Math.floor(place);
    return sorted[low] + (place - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
  };
  return { min: at(0), q1: at(0.25), median: at(0.5), q3: at(0.75), max: at(1) };
}

/** How many scores lie in 0–10, 10–20, … 90–100; 100 belongs to the last. */
export function score_bins(scores: number[]): number[] {
  const bins = new Array<number>(10).fill(0);
  for (const score of scores) bins[Math.max(0, Math.min(9, Math.floor(score / 10)))] += 1;
  return bins;
}

/** The trainees of a course (null: those without one): real ones, or simulated ones if it has no others. */
export function trainees_of(people: Person[], course: string | null): { people: Person[]; is_simulated: boolean } {
  const all = people.filter((one) => one.group === "trainee" && (one.course === null ? course === null : String(one.course) === course));
  const real = all.filter((one) => !one.simulated);
  return real.length > 0 ? { people: real, is_simulated: false } : { people: all, is_simulated: all.length > 0 };
}

/** Results of a person at a task, or at all tasks (""). */
export function results_of(person: Person, task: string): TaskResult[] {
  return task ? (person.tasks[task] ? [person.tasks[task]] : []) : Object.values(person.tasks);
}

/** One score of a person: the mean over the tasks of the mean of the last five scores. */
export function score_of(person: Person, task: string): number | null {
  const means = results_of(person, task).flatMap((one) => one.recent_mean ?? []);
  return means.length > 0 ? means.reduce((sum, one) => sum + one, 0) / means.length : null;
}

export function numbers_of(people: Person[], task: string): CourseNumbers {
  const numbers: CourseNumbers = { people: people.length, practised: 0, with_pass: 0, attempts: 0, passed: 0, scores: [], last_s: null };
  for (const person of people) {
    const results = results_of(person, task);
    const attempts = results.reduce((sum, one) => sum + one.attempts, 0);
    const passed = results.reduce((sum, one) => sum + one.passed, 0);
    const score = score_of(person, task);
    numbers.attempts += attempts;
    numbers.passed += passed;
    numbers.practised += attempts > 0 ? 1 : 0;
    numbers.with_pass += passed > 0 ? 1 : 0;
    if (score !== null) numbers.scores.push(score);
    for (const one of results) if (one.last_s !== null) numbers.last_s = Math.max(numbers.last_s ?? one.last_s, one.last_s);
  }
  numbers.scores.sort((a, b) => a - b);
  return numbers;
}

export interface CourseRow {
  /** Null: people without a course. */
  id: string | null;
  name: string;
  is_simulated: boolean;
  numbers: CourseNumbers;
}
/** Every course with its numbers at a task ("": all tasks), and the people without a course if there are any. */
export function course_rows(overview: Overview, task: string): CourseRow[] {
  const row = (id: string | null, name: string): CourseRow => {
    const { people, is_simulated } = trainees_of(overview.people, id);
    return { id, name, is_simulated, numbers: numbers_of(people, task) };
  };
  const rows = overview.courses.map((one) => row(String(one.id), one.name));
  const without = row(null, t("Without a course"));
  return without.numbers.people > 0 ? [...rows, without] : rows;
}
