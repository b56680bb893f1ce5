// Dark or light: the system's choice, unless the person chose one here.

export type Theme = "dark" | "light";
const kKey = "trocar-theme";
const system_is_light = window.matchMedia("(prefers-color-scheme: light)");

function stored(): Theme | null {
  try {
    const value = localStorage.getItem(kKey);
    return value === "dark" || value === "light" ? value : null;
  } catch {
    return null;
  }
}

export function current_theme(): Theme {
  return stored() ?? (system_is_light.matches ? "light" : "dark");
}

function apply(): void {
  document.documentElement.dataset.theme = current_theme();
  document.dispatchEvent(new Event("themechange"));
}

export function start_theme(): void {
  apply();
  system_is_light.addEventListener("change", apply);
}

function write(theme: Theme): void {
  try {
    localStorage.setItem(kKey, theme);
  } catch {
    return;  // Without storage the system's choice stays.
  }
  apply();
}

export function switch_theme(): void {
  write(current_theme() === "dark" ? "light" : "dark");
}

/** Runs `action`, after which the browser may have deleted what this page stored, and keeps the theme: it says nothing about a person. */
export async function keeping_theme<T>(action: () => Promise<T>): Promise<T> {
  const theme = stored();
  try {
    return await action();
  } finally {
    if (theme) write(theme);
  }
}

/** A colour of the style sheet, for canvases: colour("accent"). */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export function on_theme_change(signal: AbortSignal, handler: () => void): void {
  document.addEventListener("themechange", handler, { signal });
}
