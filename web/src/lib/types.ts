// The server's answers. Times are seconds since 1970 (UTC); a missing value is null.

export interface Account {
  name: string;
  role: "admin" | "instructor";
}
export interface Me {
  account: Account;
  csrf: string;
  program_version?: string;
}

export interface Task {
  id: string;
  title: string;
}
export interface Course {
  id: string | number;
  name: string;
}
export interface TaskResult {
  /** That count: without a result they are not passed. */
  attempts: number;
  scored: number;
  passed: number;
  last_score: number | null;
  best_score: number | null;
  recent_mean: number | null;
  last_s: number | null;
  unscored: number;
  never_began: number;
  lost: number;
  running: number;
  /** What was counted, what was left out and why. */
  counts_text?: string;
}
export interface Person {
  id: string;
  name: string;
  group: "trainee" | "expert";
  course: string | number | null;
  simulated: boolean;
  has_pin?: boolean;
  tasks: Record<string, TaskResult>;
}
export interface Overview {
  tasks: Task[];
  courses: Course[];
  people: Person[];
}
export interface PersonAnswer {
  person: Person;
  tasks: Task[];
  courses: Course[];
}

export interface Attempt {
  id: string;
  sequence: number;
  task: string;
  patient: string;
  difficulty: number | string | null;
  level: string | null;
  started_s: number;
  state: string;
  score: number | null;
  passed: boolean | null;
  duration_s: number | null;
  station: string | null;
  /** Why it did not pass; in lists and in the attempt itself. */
  fails?: string[];
  not_scored?: string | boolean | null;
}
export interface ListedAttempt extends Attempt {
  /** Number of notes. */
  notes?: number;
}
export interface Note {
  id: string;
  author: string;
  text: string;
  written_s: number;
}
export interface AttemptList {
  attempts: ListedAttempt[];
  next: number | null;
}

export interface CurvePoint {
  n: number;
  attempt: string;
  started_s: number;
  score: number | null;
  passed: boolean | null;
  patient: string;
  difficulty: number | string | null;
  moving_mean: number | null;
}
export interface Curve {
  points: CurvePoint[];
  cusum: { values: (number | null)[]; upper: number; lower: number; acceptable: number; unacceptable: number } | null;
  experts: { n: number; simulated?: boolean; mean: number | null; low: number | null; high: number | null } | null;
  peers: { n: number; mean_by_attempt: (number | null)[] } | null;
  counts_text?: string;
}

export type Better = "lower" | "higher" | "neither";
export interface MetricName {
  name: string;
  title: string;
  unit: string;
  better: Better;
}
export interface MetricGroup {
  group: string;
  simulated: boolean;
  /** People: each counts once, with the mean of the attempts. */
  n: number;
  attempts: number;
  counts: number[];
  min: number | null;
  q1: number | null;
  median: number | null;
  q3: number | null;
  max: number | null;
}
export interface MetricDistribution extends MetricName {
  edges: number[];
  groups: MetricGroup[];
  auc: { value: number; low: number | null; high: number | null } | null;
  reason?: string | null;
}

export interface ScorePart {
  name: string;
  title: string;
  value_text: string | null;
  points: number;
  max_points: number;
}
export interface MetricValue extends MetricName {
  value: number | null;
  expert_median: number | null;
  expert_q1: number | null;
  expert_q3: number | null;
}
export interface AttemptAnswer {
  attempt: Attempt & {
    task_title?: string;
    person: { id: string; name: string; simulated: boolean };
    not_scored: string | boolean | null;
    fails: string[];
    hints: { text: string; at_s: number | null }[];
  };
  notes?: Note[];
  parts: ScorePart[];
  metrics: MetricValue[];
}

export type Point3 = [number, number, number];
/** Frame P (LPS, mm). Force along the needle; negative pushes the needle out. */
export interface Trace {
  rate_hz: number;
  time_s: number[];
  tip_x_mm: (number | null)[];
  tip_y_mm: (number | null)[];
  tip_z_mm: (number | null)[];
  depth_mm: (number | null)[];
  force_n: (number | null)[];
  tissue: (number | null)[];
  tissues: string[];
  plan: { entry: Point3; target: Point3 } | null;
  events: { time_s: number; text: string }[];
  expert?: Trace | null;
}

export interface ValidityMetric {
  name: string;
  title: string;
  unit: string;
  better?: Better;
  n_expert: number | null;
  n_novice: number | null;
  expert_median: number | null;
  novice_median: number | null;
  auc: number | null;
  low: number | null;
  high: number | null;
  p: number | null;
  /** Corrected for the number of metrics; `discriminates` is judged by it. */
  p_corrected?: number | null;
  discriminates: boolean | null;
  reason?: string | null;
}
export interface Validity {
  task: string;
  experts: number;
  novices: number;
  simulated: boolean;
  patients?: string[];
  levels?: string[];
  counts_text?: string;
  expert_attempts?: number;
  novice_attempts?: number;
  expert_unscored?: number;
  novice_unscored?: number;
  score?: ValidityMetric | null;
  /** Share of passed attempts. */
  passed?: ValidityMetric | null;
  metrics: ValidityMetric[] | null;
  discriminating: { share: number | null; count: number | null; of: number | null; uncorrected?: number | null; note?: string | null; reason?: string | null } | null;
  alpha: { value: number | null; low?: number | null; high?: number | null; items: number | null; n: number | null; reason?: string | null } | null;
  pass_mark: {
    value: number | null;
    false_passes: number | null;
    false_fails: number | null;
    experts: number | null;
    novices: number | null;
    reason?: string | null;
  } | null;
  reason?: string | null;
}

export interface PersonProficiency {
  id: string;
  name: string;
  attempts: number;
  passed: number;
  /** Attempts up to proficiency; null: not yet. */
  trials: number | null;
  practice_s: number;
  first_pass_share: number | null;
  time_to_target_s: number | null;
  /** Entered by instructors; null: nothing. */
  instructor_min: number | null;
}
export interface GroupProficiency {
  group: "trainee" | "expert";
  simulated: boolean;
  counts_text: string;
  people_count: number;
  proficient: number;
  not_yet: number;
  median: number | null;
  low: number | null;
  high: number | null;
  curve: { trials: number; at_risk: number; open_share: number }[];
  practice_s: number;
  instructor: string;
  instructor_min: number | null;
  first_pass_share: number | null;
  time_to_target_s: number | null;
  people: PersonProficiency[];
}
export interface Proficiency {
  task: string;
  score: number;
  passes_in_a_row: number;
  patients: string[];
  levels: string[];
  groups: GroupProficiency[];
}

export interface FormItem {
  id?: string | number;
  kind: "scale" | "text";
  text: string;
  is_required: boolean;
}
export interface Form {
  id: string | number;
  token: string;
  title: string;
  intro: string;
  is_open: boolean;
  language?: string | null;
  responses: number;
  items: FormItem[];
}
export interface ItemSummary {
  id: string | number;
  kind: "scale" | "text";
  text: string;
  /** Its text was changed after answers were given. */
  is_retired?: boolean;
  n: number;
  mean?: number | null;
  sd?: number | null;
  counts?: number[];
  comments?: { text: string; submitted_s: number | null }[];
}
export interface FormSummary {
  form: Form;
  responses: number;
  items: ItemSummary[];
}
export interface PublicForm {
  title: string;
  intro: string;
  language?: string | null;
  items: FormItem[];
}
