import type { Me } from "./lib/types.ts";

/** The signed-in account; null before the login. */
export const session: { me: Me | null } = { me: null };

export function is_admin(): boolean {
  return session.me?.account.role === "admin";
}
