// Made-up people and attempts, only for tests of the page. Nobody here exists, and no number was measured.

import { Random } from "./random.ts";

export interface MockPerson {
  id: string;
  name: string;
  group: "trainee" | "expert";
  course: string | null;
  simulated: boolean;
  has_pin?: boolean;
  skill: number;  ///< 0 novice … 1 expert, at the first attempt.
}
export interface MockAttempt {
  id: string;
  sequence: number;
  person: string;
  task: string;
  patient: string;
  difficulty: number;
  level: string;
  started_s: number;
  state: string;
  score: number | null;
  passed: boolean | null;
  duration_s: number;
  station: string;
  skill: number;
  notes: MockNote[];
}
export interface MockNote {
  id: string;
  author: string;
  text: string;
  written_s: number;
}

export const kTasks = [
  { id: "ascites-puncture", title: "Ascites puncture" },
  { id: "liver-biopsy", title: "Liver biopsy" },
  { id: "lumbar-puncture", title: "Lumbar puncture" },
  { id: "ptcd", title: "Bile duct puncture (PTCD)" },
];
export const kCourses = [
  { id: "Radiology residents 2026", name: "Radiology residents 2026" },
  { id: "Hepatology course, autumn", name: "Hepatology course, autumn" },
];
export const kHtmlName = `<img src=x onerror="document.title='broken'"> <b>Bold</b>`;
export const kSqlName = "Robert'); DROP TABLE people;--";

const kNames = ["Amara Osei", "Björn Lindqvist", "Chen Wei", "Daniela Rossi", "Emre Yılmaz", "Fatima al-Sayed", "Grace O'Connor", "Hiroshi Tanaka", kHtmlName, kSqlName, "Karoline von Hohenstein-Großmann-Wiśniewska"];
const kStart_s = Date.UTC(2026, 8, 1, 7) / 1000;

function hex(random: Random): string {
  return Array.from({ length: 32 }, () => Math.floor(random.uniform(0, 16)).toString(16)).join("");
}

export function make_people(random: Random): MockPerson[] {
  const people: MockPerson[] = [];
  for (let k = 1; k <= 2; k += 1) people.push({ id: hex(random), name: `Simulated expert ${k}`, group: "expert", course: null, simulated: true, skill: 0.95 });
  for (let k = 1; k <= 12; k += 1) people.push({ id: hex(random), name: `Simulated novice ${k}`, group: "trainee", course: null, simulated: true, skill: random.uniform(0.1, 0.35) });
  people.push({ id: hex(random), name: "Prof. Ingrid Sommer", group: "expert", course: null, simulated: false, skill: 0.9 });
  kNames.forEach((name, k) => people.push({ id: hex(random), name, group: "trainee", course: kCourses[k % 2].id, simulated: false, skill: random.uniform(0.15, 0.5) }));
  people.push({ id: hex(random), name: "Zoë Nobody-yet", group: "trainee", course: kCourses[0].id, simulated: false, skill: 0.2 });
  return people;
}

export function make_attempts(random: Random, people: MockPerson[]): MockAttempt[] {
  const attempts: MockAttempt[] = [];
  for (const person of people) {
    if (person.name.startsWith("Zoë")) continue;
    for (const task of kTasks) {
      const count = task.id === "liver-biopsy" ? Math.round(random.uniform(22, 70)) : Math.round(random.uniform(0, 14));
      for (let n = 0; n < count; n += 1) {
        const skill = Math.min(1, person.skill + (1 - person.skill) * (1 - Math.exp(-n / 18)) * 0.9);
        const scored = random.uniform() > 0.04;
        const score = Math.max(4, Math.min(99, random.normal(34 + 58 * skill, 9)));
        attempts.push({
          id: hex(random), sequence: 0, person: person.id, task: task.id,
          patient: `${task.id === "liver-biopsy" ? "biopsy" : task.id.split("-")[0]}-${1 + Math.floor(random.uniform(0, 5))}`,
          difficulty: 1 + Math.floor(random.uniform(0, 5)), level: random.pick(["guided", "assisted", "exam"]),
          started_s: Math.round(kStart_s + Math.floor(n * 0.9) * 86400 + random.uniform(0, 9 * 3600)), state: scored ? "finished" : n % 2 ? "unscored" : "interrupted",
          score: scored ? score : null, passed: scored ? score >= 70 && random.uniform() > 0.05 : n % 2 ? false : null,
          duration_s: random.normal(130 - 70 * skill, 8), station: random.pick(["station-1", "station-2"]), skill, notes: [],
        });
      }
    }
  }
  attempts.sort((a, b) => a.started_s - b.started_s);
  attempts.forEach((one, k) => (one.sequence = k + 1));
  return attempts;
}
