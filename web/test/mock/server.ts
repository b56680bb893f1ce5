// A server for tests of the page: the interface of `trocar serve` with made-up data in memory. It is never shipped.

import { randomBytes } from "node:crypto";
import { readFile } from "node:fs/promises";
import { createServer, type IncomingMessage, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { extname, join, normalize } from "node:path";
import { MockResults } from "./answers.ts";
import { MockForms } from "./forms.ts";

export const kPolicy = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const kTypes: Record<string, string> = { ".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css; charset=utf-8", ".svg": "image/svg+xml" };

interface Session {
  name: string;
  csrf: string;
}
interface Failure {
  path: string;
  status: number;
  headers: Record<string, string>;
}
class HttpError extends Error {
  constructor(readonly status: number, message: string, readonly advice: string, readonly headers: Record<string, string> = {}) {
    super(message);
  }
}

export class MockServer {
  readonly results = new MockResults();
  readonly forms = new MockForms();
  readonly accounts = new Map([["Dr. Weber", { password: "a long test password", role: "admin" }], ["instructor", { password: "another long password", role: "instructor" }]]);
  answers_received = 0;
  pins_required = false;
  private readonly sessions = new Map<string, Session>();
  private failures: Failure[] = [];
  private failed_logins = 0;
  private readonly server = createServer((request, response) => void this.handle(request, response));

  constructor(private readonly folder: string) {}

  async start(port = 0): Promise<string> {
    await new Promise<void>((done) => this.server.listen(port, "127.0.0.1", done));
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}`;
  }
  async stop(): Promise<void> {
    this.server.closeAllConnections();
    await new Promise<void>((done) => this.server.close(() => done()));
  }
  expire_sessions(): void {
    this.sessions.clear();
  }
  /** The next request whose path begins so fails with this status. */
  fail_next(path: string, status: number, headers: Record<string, string> = {}): void {
    this.failures.push({ path, status, headers });
  }

  private async handle(request: IncomingMessage, response: ServerResponse): Promise<void> {
    response.setHeader("Content-Security-Policy", kPolicy);
    response.setHeader("X-Content-Type-Options", "nosniff");
    const url = new URL(request.url ?? "/", "http://localhost");
    try {
      const failure = this.failures.find((one) => url.pathname.startsWith(one.path));
      if (failure) {
        this.failures = this.failures.filter((one) => one !== failure);
        throw new HttpError(failure.status, `failure ${failure.status} for the test`, "advice for the test", failure.headers);
      }
      if (!url.pathname.startsWith("/api/")) return await this.send_file(url.pathname, response);
      const answer = await this.answer(request, url, response);
      if (answer === undefined) response.writeHead(204).end();
      else if (typeof answer === "string") response.writeHead(200, { "Content-Type": "text/csv", "Content-Disposition": 'attachment; filename="attempts.csv"' }).end(answer);
      else response.writeHead(request.method === "POST" && url.pathname.endsWith("/answers") ? 201 : 200, { "Content-Type": "application/json" }).end(JSON.stringify(answer));
    } catch (error) {
      const known = error instanceof HttpError ? error : new HttpError(500, String(error), "look at the mock server");
      response.writeHead(known.status, { "Content-Type": "application/json", ...known.headers }).end(JSON.stringify({ error: known.message, advice: known.advice }));
    }
  }

  private async send_file(path: string, response: ServerResponse): Promise<void> {
    const file = extname(path) ? normalize(path).replace(/^(\.\.[/\\])+/, "") : "index.html";
    try {
      const bytes = await readFile(join(this.folder, file));
      response.writeHead(200, { "Content-Type": kTypes[extname(file)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  }

  private async body(request: IncomingMessage): Promise<any> {
    let text = "";
    for await (const part of request) text += part;
    if (request.headers["content-type"] !== "application/json") throw new HttpError(415, "not JSON", "send application/json");
    return JSON.parse(text || "{}");
  }

  private login(body: { name?: string; password?: string }, response: ServerResponse): unknown {
    if (this.failed_logins >= 5) throw new HttpError(429, "too many failed logins", "wait, then try again", { "Retry-After": "30" });
    const account = this.accounts.get(body.name ?? "");
    if (!account || account.password !== body.password) {
      this.failed_logins += 1;
      throw new HttpError(401, "name or password is wrong", "check both, mind upper and lower case");
    }
    this.failed_logins = 0;
    const token = randomBytes(16).toString("hex");
    const csrf = randomBytes(16).toString("hex");
    this.sessions.set(token, { name: body.name!, csrf });
    response.setHeader("Set-Cookie", `trocar_session=${token}; HttpOnly; SameSite=Strict; Path=/`);
    return { account: { name: body.name, role: account.role }, csrf };
  }

  private async answer(request: IncomingMessage, url: URL, response: ServerResponse): Promise<unknown> {
    const parts = url.pathname.split("/").slice(2).map(decodeURIComponent);
    const method = request.method ?? "GET";
    const found = <T>(value: T | null | undefined): T => {
      if (value === null || value === undefined) throw new HttpError(404, `not found — ${url.pathname}`, "check the address");
      return value;
    };
    if (parts[0] === "login") return this.login(await this.body(request), response);
    if (parts[0] === "public") {
      const form = found(this.forms.open_by_token(parts[2]));
      if (method === "GET") return { title: form.title, intro: form.intro, items: form.items };
      const { answers, response_id } = await this.body(request);
      const problem = this.forms.add(form, answers, response_id);
      if (problem) throw new HttpError(400, problem, "correct the answer");
      this.answers_received += 1;
      return {};
    }
    const token = /trocar_session=(\w+)/.exec(request.headers.cookie ?? "")?.[1] ?? "";
    const session = this.sessions.get(token);
    if (!session) throw new HttpError(401, "no session", "sign in");
    const body = method === "GET" ? null : await this.body(request);
    if (method !== "GET" && request.headers["x-csrf-token"] !== session.csrf) throw new HttpError(403, "X-CSRF-Token is missing or wrong", "reload the page");
    if (parts[0] === "logout") response.setHeader("Clear-Site-Data", '"cache", "storage"');
    return this.answer_session(method, parts, url.searchParams, body, session, token, found);
  }

  private answer_session(method: string, parts: string[], query: URLSearchParams, body: any, session: Session, token: string, found: <T>(value: T | null | undefined) => T): unknown {
    const role = this.accounts.get(session.name)!.role;
    const task = query.get("task") ?? "";
    const needs_admin = (): void => {
      if (role !== "admin") throw new HttpError(403, "this needs an administrator", "ask an administrator");
    };
    switch (parts[0]) {
      case "logout":
        this.sessions.delete(token);
        return undefined;
      case "me":
        return { account: { name: session.name, role }, csrf: session.csrf, program_version: "0.23.0" };
      case "password":
        if (body.old !== this.accounts.get(session.name)!.password) throw new HttpError(403, "the current password is wrong", "type it again");
        return undefined;
      case "accounts":
        needs_admin();
        if (parts[2] === "password") {
          found(this.accounts.get(parts[1])).password = body.password;
          return undefined;
        }
        if (method === "POST") this.accounts.set(body.name, { password: body.password, role: body.role });
        if (method === "DELETE") this.accounts.delete(parts[1]);
        return method === "GET" ? { accounts: [...this.accounts].map(([name, one]) => ({ name, role: one.role })) } : undefined;
      case "overview":
        return this.results.overview(query.get("course"));
      case "people":
        if (method === "DELETE") {
          needs_admin();
          return this.results.delete_person(parts[1]);
        }
        if (method === "POST" || method === "PUT") return this.change_people(method, parts, body, found);
        if (parts[2] === "attempts") return this.results.list(parts[1], task, Number(query.get("before") ?? 1e9), Number(query.get("limit") ?? 50));
        return parts[2] === "curve" ? this.results.curve(parts[1], task) : found(this.results.person(parts[1]));
      case "courses":
        if (method === "DELETE") this.results.courses.splice(this.results.courses.findIndex((one) => one.id === body.name), 1);
        else this.results.rename_course(body.name, body.new_name);
        return undefined;
      case "pins":
        if (method === "PUT") needs_admin();
        if (method === "PUT") this.pins_required = body.required;
        return { required: this.pins_required };
      case "notes":
        this.results.delete_note(parts[1]);
        return undefined;
      case "metrics":
        return parts[1] ? found(this.results.distribution(parts[1], task, query.get("course") ?? "")) : this.results.metrics();
      case "attempts":
        if (parts[2] === "recording") return found(null);
        if (parts[2] === "notes") {
          const note = { id: randomBytes(16).toString("hex"), author: session.name, text: body.text.trim(), written_s: Math.floor(Date.now() / 1000) };
          found(this.results.find_attempt(parts[1])).notes.push(note);
          return note;
        }
        return found(parts[2] === "trace" ? this.results.trace(parts[1]) : this.results.attempt(parts[1]));
      case "export":
        return this.results.csv();
      case "validity":
        return this.results.validity(task, query.get("patient") ?? "", query.get("level") ?? "");
      case "proficiency":
        return this.results.proficiency(task, query.get("patient") ?? "", query.get("level") ?? "");
      case "forms":
        return this.answer_forms(method, parts, body, found);
      default:
        return found(null);
    }
  }

  private change_people(method: string, parts: string[], body: any, found: <T>(value: T | null | undefined) => T): unknown {
    const { results } = this;
    if (parts[1] === "move") {
      for (const id of body.people) found(results.find_person(id)).course = results.course_of(body.course);
      return undefined;
    }
    if (parts[2] === "pin") {
      found(results.find_person(parts[1])).has_pin = body.pin !== "";
      return undefined;
    }
    if (results.people.some((one) => one.name.toLowerCase() === body.name.toLowerCase() && one.id !== parts[1])) throw new HttpError(409, "another person has this name", "choose another name");
    const person = method === "PUT" ? found(results.find_person(parts[1])) : { id: randomBytes(16).toString("hex"), name: "", group: "trainee" as const, course: null, simulated: false, skill: 0.2 };
    Object.assign(person, { name: body.name, group: body.group, course: results.course_of(body.course) });
    if (method === "POST") results.people.push(person);
    return { id: person.id, name: person.name };
  }

  private answer_forms(method: string, parts: string[], body: any, found: <T>(value: T | null | undefined) => T): unknown {
    if (!parts[1]) return method === "POST" ? this.forms.create(body) : this.forms.list();
    const form = found(this.forms.find(parts[1]));
    if (method === "PUT") return this.forms.update(form, body);
    if (method === "DELETE") return this.forms.remove(form);
    return parts[2] === "answers.csv" ? "item,answer\r\n" : this.forms.summary(form);
  }
}
