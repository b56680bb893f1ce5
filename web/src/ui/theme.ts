// Dark or light: the system's choice, unless the person chose one here.

import { read_choice, write_choice } from "../lib/choices.ts";

export type Theme = "dark" | "light";
const system_is_light = window.matchMedia("(prefers-color-scheme: light)");

function stored(): Theme | null {
  const value = read_choice("trocar-theme");
  return value === "dark" || value === "light" ? value : null;
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

/** Without storage the system's choice stays. */
export function switch_theme(): void {
  if (write_choice("trocar-theme", current_theme() === "dark" ? "light" : "dark")) apply();
}

/** A colour of the style sheet, for canvases: colour("accent"). */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export function on_theme_change(signal: AbortSignal, handler: () => void): void {
  document.addEventListener("themechange", handler, { signal });
}
