// Requests to the server: JSON in, JSON out; errors carry the server's text and its advice.

import { capital, sentence } from "./format.ts";
import { said, t } from "./words.ts";

export class ApiError extends Error {
  constructor(readonly status: number, message: string, readonly advice: string, readonly retry_after_s: number | null = null) {
    super(message);
  }
}

interface Session {
  csrf: string | null;
  on_expired: () => void;
}

const session: Session = { csrf: null, on_expired: () => {} };

export function set_csrf(token: string | null): void {
  session.csrf = token;
}

/** Called when a request with a session is answered by 401. */
export function on_session_expired(handler: () => void): void {
  session.on_expired = handler;
}

const advice_by_status = (): Record<number, string> => ({
  403: t("Reload the page and try again. If it happens again, ask an administrator for permission."),
  404: t("It may have been deleted. Go back to the list."),
  413: t("Shorten the text."),
  429: t("Wait a moment, then try again."),
});

async function error_of(response: Response): Promise<ApiError> {
  let text = t("The server answered with status {0}", response.status);
  let advice = advice_by_status()[response.status] ?? t("Try again. If it happens again, tell the administrator: the log of trocar serve has the reason.");
  try {
    const body = (await response.json()) as { error?: unknown; advice?: unknown };
    if (typeof body.error === "string" && body.error) text = capital(said(body.error));
    if (typeof body.advice === "string" && body.advice) advice = sentence(said(body.advice));
  } catch {
    // Not JSON, for instance from a proxy between: the status says enough.
  }
  const seconds = Number(response.headers.get("Retry-After"));
  return new ApiError(response.status, text, advice, seconds > 0 ? seconds : null);
}

interface Options {
  signal?: AbortSignal | undefined;
  /** Requests of the public page and the login: a 401 is an answer, not the end of a session. */
  without_session?: boolean;
}

async function request<T>(method: string, path: string, body: unknown, options: Options): Promise<T> {
  const headers: Record<string, string> = { Accept: "application/json" };
  if (method !== "GET") {
    headers["Content-Type"] = "application/json";
    if (session.csrf) headers["X-CSRF-Token"] = session.csrf;
  }
  let response: Response;
  let text = "";
  try {
    response = await fetch(path, {
      method,
      headers,
      body: method === "GET" ? null : JSON.stringify(body ?? {}),
      signal: options.signal ?? null,
      credentials: "same-origin",
      cache: "no-store",
    });
    // The connection may end in the middle of the answer, too.
    if (response.ok && response.status !== 204) text = await response.text();
  } catch (error) {
    if (options.signal?.aborted) throw error;
    throw new ApiError(0, t("The server does not answer"), t("Check the network connection, and that trocar serve is running. Then try again."));
  }
  if (response.status === 401 && !options.without_session) session.on_expired();
  if (!response.ok) throw await error_of(response);
  if (response.status === 204) return undefined as T;
  try {
    return (text ? JSON.parse(text) : undefined) as T;
  } catch {
    throw new ApiError(response.status, t("The server's answer cannot be read"), t("Try again. A proxy between this browser and the server may have changed it."));
  }
}

export function get<T>(path: string, signal?: AbortSignal, options: Options = {}): Promise<T> {
  return request<T>("GET", path, null, { ...options, signal });
}

export function send<T>(method: "POST" | "PUT" | "DELETE", path: string, body: unknown, options: Options = {}): Promise<T> {
  return request<T>(method, path, body, options);
}

/** "/api/x?task=a" from the parts that are not empty. */
export function path_with(path: string, query: Record<string, string | number | null | undefined>): string {
  const parts = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value !== null && value !== undefined && value !== "") parts.set(name, String(value));
  }
  const text = parts.toString();
  return text ? `${path}?${text}` : path;
}
