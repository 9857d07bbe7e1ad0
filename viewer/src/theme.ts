// Light and dark: as the system, until the button chooses one of them.

import { button } from "./dom";

const KEY = "smachac-theme";

type Theme = "light" | "dark";

export function themeSwitch(): HTMLButtonElement {
  const system = window.matchMedia("(prefers-color-scheme: dark)");
  let theme: Theme = stored() ?? (system.matches ? "dark" : "light");
  const made = button("Dark colours", "◐", () => {
    apply(theme === "dark" ? "light" : "dark");
    store(theme);
  }, "Light or dark");
  const apply = (next: Theme): void => {
    theme = next;
    document.documentElement.dataset["theme"] = next;
    made.setAttribute("aria-pressed", String(next === "dark"));
  };
  system.addEventListener("change", () => stored() ?? apply(system.matches ? "dark" : "light"));
  apply(theme);
  return made;
}

// A page from a file may have no storage.
function stored(): Theme | null {
  try {
    const value = localStorage.getItem(KEY);
    return value === "light" || value === "dark" ? value : null;
  } catch {
    return null;
  }
}

function store(theme: Theme): void {
  try {
    localStorage.setItem(KEY, theme);
  } catch {
    // Without storage the choice lasts as long as the page.
  }
}
