// Questionnaires of the mock server, in memory.

import { Random } from "./random.ts";

interface Item {
  id: string;
  kind: "scale" | "text";
  text: string;
  is_required: boolean;
}
interface Form {
  id: string;
  token: string;
  title: string;
  intro: string;
  is_open: boolean;
  language: string;
  items: Item[];
}
type Answers = Record<string, unknown>;

const kStandard: Omit<Item, "id">[] = [1, 2, 3, 4].map((one) => ({ kind: "scale", text: `Standard statement ${one}`, is_required: true }));

export class MockForms {
  private readonly forms: Form[] = [];
  private readonly responses = new Map<string, { answers: Answers; submitted_s: number; id?: string }[]>();
  private next_id = 1;

  constructor() {
    const random = new Random(5);
    const form = this.create({
      title: "Simulator study",
      intro: "Please answer after your last puncture of today. Your answers are anonymous.",
      items: [
        { kind: "scale", text: "Training with the simulator is useful before the first puncture of a patient.", is_required: true },
        { kind: "scale", text: "The images and the body look realistic.", is_required: true },
        { kind: "scale", text: "The forces at the needle feel realistic.", is_required: true },
        { kind: "scale", text: "I am more confident about my first puncture of a patient.", is_required: true },
        { kind: "text", text: "What should be improved?", is_required: false },
      ],
    });
    const comments = ["The skin is a little too stiff, otherwise very close to a patient.", "More cases with thin patients, please.\nAnd a left-handed set-up.", "<script>alert('comment')</script>", ""];
    for (let k = 0; k < 18; k += 1) {
      const answers: Answers = {};
      form.items.forEach((one, i) => {
        if (one.kind === "scale") answers[one.id] = Math.max(1, Math.min(6, Math.round(random.normal(1.6 + 0.4 * i, 0.9))));
        else if (comments[k % 4] && k < 4) answers[one.id] = comments[k];
      });
      this.responses.get(form.id)!.push({ answers, submitted_s: 1_790_000_000 + 3600 * k });
    }
    this.create({ title: "Feedback on the course", intro: "", items: [{ kind: "text", text: "What did you miss?", is_required: true }] }).is_open = false;
  }

  create(given: { title?: string; intro?: string; items?: Omit<Item, "id">[] }): Form {
    const body = { title: "Your opinion", items: kStandard, ...given };
    const id = String(this.next_id++);
    const token = `test-token-${id}-abcdefghijklmnop`;
    const items = body.items.map((one, k) => ({ id: `${id}-${k}-${this.next_id++}`, kind: one.kind, text: one.text, is_required: one.is_required }));
    const form: Form = { id, token, title: body.title, intro: body.intro ?? "", is_open: true, language: "en", items };
    this.forms.push(form);
    this.responses.set(id, []);
    return form;
  }
  private listed(form: Form): unknown {
    return { ...form, responses: this.responses.get(form.id)!.length };
  }
  list(): unknown {
    return { forms: this.forms.map((one) => this.listed(one)) };
  }
  find(id: string): Form | undefined {
    return this.forms.find((one) => one.id === id);
  }
  open_by_token(token: string): Form | undefined {
    return this.forms.find((one) => one.token === token && one.is_open);
  }
  update(form: Form, body: Partial<Form>): unknown {
    if (body.title !== undefined) form.title = body.title;
    if (body.intro !== undefined) form.intro = body.intro;
    if (body.is_open !== undefined) form.is_open = body.is_open;
    if (body.items) {
      const before = new Map(form.items.map((one) => [one.id, one]));
      form.items = body.items.map((one) => {
        const same = before.get(one.id);
        return { ...one, id: same && same.text === one.text ? same.id : `${form.id}-new-${this.next_id++}` };
      });
    }
    return this.listed(form);
  }
  remove(form: Form): void {
    this.forms.splice(this.forms.indexOf(form), 1);
  }
  summary(form: Form): unknown {
    const responses = this.responses.get(form.id)!;
    const items = form.items.map((item) => {
      const given = responses.filter((one) => one.answers[item.id] !== undefined);
      const base = { id: item.id, kind: item.kind, text: item.text, n: given.length };
      if (item.kind === "text") return { ...base, comments: given.map((one) => ({ text: one.answers[item.id], submitted_s: one.submitted_s })) };
      const values = given.map((one) => Number(one.answers[item.id]));
      const mean = values.length ? values.reduce((a, b) => a + b, 0) / values.length : null;
      const sd = values.length > 1 ? Math.sqrt(values.reduce((a, b) => a + (b - mean!) ** 2, 0) / (values.length - 1)) : null;
      return { ...base, mean, sd, counts: [1, 2, 3, 4, 5, 6].map((one) => values.filter((value) => value === one).length) };
    });
    return { form: this.listed(form), responses: responses.length, items };
  }
  /** Null, or the error of an answer. */
  add(form: Form, answers: Answers, id: string): string | null {
    for (const item of form.items) {
      const value = answers[item.id];
      if (value === undefined && item.is_required) return `item "${item.text}" has no answer`;
      if (item.kind === "scale" && value !== undefined && !(Number.isInteger(value) && Number(value) >= 1 && Number(value) <= 6)) return `item "${item.text}" is not 1 to 6`;
    }
    const all = this.responses.get(form.id)!;
    if (!all.some((one) => one.id === id)) all.push({ answers, submitted_s: Math.floor(Date.now() / 1000), id });
    return null;
  }
}
