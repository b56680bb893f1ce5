// What a person chose in the page's head: kept by the browser, and nothing about the person.

type Choice = "trocar-theme" | "trocar-language";
const kChoices: Choice[] = ["trocar-theme", "trocar-language"];

export function read_choice(name: Choice): string | null {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

/** False without storage. */
export function write_choice(name: Choice, value: string): boolean {
  try {
    localStorage.setItem(name, value);
    return true;
  } catch {
    return false;
  }
}

/** Runs `action`, after which the browser may have deleted what this page stored, and keeps the choices. */
export async function keeping_choices<T>(action: () => Promise<T>): Promise<T> {
  const before = kChoices.map((name) => [name, read_choice(name)] as const);
  try {
    return await action();
  } finally {
    for (const [name, value] of before) if (value !== null) write_choice(name, value);
  }
}
