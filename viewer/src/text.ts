// Texts in the picture: their fonts, and their widths before they are drawn.

const FAMILY = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans", Arial, sans-serif';

export const FONTS = {
  title: `600 14px ${FAMILY}`,
  name: `600 13px ${FAMILY}`,
  detail: `11px ${FAMILY}`,
  label: `11px ${FAMILY}`,
  chip: `10px ${FAMILY}`,
  exit: `600 11px ${FAMILY}`,
} as const;

export type FontName = keyof typeof FONTS;

const LONGEST = 300;
/** The widest text of the picture, in pixels; longer ones are cut (the panel shows them whole). */

const context = document.createElement("canvas").getContext("2d")!;
const widths = new Map<string, number>();

export function width(text: string, font: FontName): number {
  const key = `${font} ${text}`;
  let known = widths.get(key);
  if (known === undefined) {
    context.font = FONTS[font];
    known = Math.ceil(context.measureText(text).width);
    widths.set(key, known);
  }
  return known;
}

/** A text that fits the picture: cut with an ellipsis if it is too long. */
export function fitting(text: string, font: FontName, most: number = LONGEST): string {
  if (width(text, font) <= most) return text;
  let low = 0;
  let high = text.length;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (width(`${text.slice(0, middle)}…`, font) <= most) low = middle;
    else high = middle - 1;
  }
  return `${text.slice(0, low)}…`;
}
