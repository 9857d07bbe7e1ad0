// The part of the picture that is seen: zoom with the wheel, pan with the mouse, fit.

import type { Area } from "./layout";

const LEAST = 0.02;
const MOST = 3;
const MARGIN = 24;

export class Camera {
  private scale = 1;
  private x = 0;
  private y = 0;

  constructor(
    private readonly frame: SVGSVGElement,
    private readonly content: SVGGElement,
  ) {
    frame.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    frame.addEventListener("pointerdown", (event) => this.drag(event));
  }

  /** The scale at which an area is seen as a whole. */
  fitting(area: { width: number; height: number }): number {
    const { clientWidth, clientHeight } = this.frame;
    const across = (clientWidth - 2 * MARGIN) / Math.max(1, area.width);
    const down = (clientHeight - 2 * MARGIN) / Math.max(1, area.height);
    return Math.min(1.25, Math.max(LEAST, Math.min(across, down)));
  }

  /** Show an area as a whole, hardly enlarged. */
  fit(area: Area): void {
    const { clientWidth, clientHeight } = this.frame;
    this.scale = this.fitting(area);
    this.x = (clientWidth - area.width * this.scale) / 2 - area.x * this.scale;
    this.y = (clientHeight - area.height * this.scale) / 2 - area.y * this.scale;
    this.apply();
  }

  /** Show the upper part of a picture around a place, at a scale: no space is left of a wide picture. */
  start(place: { x: number }, width: number, scale: number): void {
    const half = this.frame.clientWidth / 2;
    this.scale = scale;
    this.x = half - Math.max(place.x, Math.min(width / 2, half / scale)) * scale;
    this.y = MARGIN;
    this.apply();
  }

  /** Zoom by a factor; the point (in pixels of the frame) stays where it is. */
  zoom(factor: number, x = this.frame.clientWidth / 2, y = this.frame.clientHeight / 2): void {
    const scale = Math.min(MOST, Math.max(LEAST, this.scale * factor));
    this.x = x - ((x - this.x) * scale) / this.scale;
    this.y = y - ((y - this.y) * scale) / this.scale;
    this.scale = scale;
    this.apply();
  }

  pan(dx: number, dy: number): void {
    this.x += dx;
    this.y += dy;
    this.apply();
  }

  /** Pan as little as is needed to show an area; at least its upper left corner. */
  reveal(area: Area): void {
    const { clientWidth, clientHeight } = this.frame;
    if (this.scale < 0.35) this.zoom(0.6 / this.scale);
    const left = area.x * this.scale + this.x;
    const top = area.y * this.scale + this.y;
    const right = Math.min(left + area.width * this.scale, left + clientWidth - 2 * MARGIN);
    const bottom = Math.min(top + area.height * this.scale, top + clientHeight - 2 * MARGIN);
    const dx = left < MARGIN ? MARGIN - left : Math.min(0, clientWidth - MARGIN - right);
    const dy = top < MARGIN ? MARGIN - top : Math.min(0, clientHeight - MARGIN - bottom);
    if (dx || dy) this.pan(dx, dy);
  }

  /** Move the picture so that what was at one place of it is where another place was. */
  keep(before: { x: number; y: number }, after: { x: number; y: number }): void {
    this.pan((before.x - after.x) * this.scale, (before.y - after.y) * this.scale);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const box = this.frame.getBoundingClientRect();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
    const factor = Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0015));
    this.zoom(factor, event.clientX - box.left, event.clientY - box.top);
  }

  private drag(start: PointerEvent): void {
    if (start.button !== 0) return;
    let { clientX, clientY } = start;
    let moving = false;
    const move = (event: PointerEvent): void => {
      if (!moving && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY) < 4) return;
      if (!moving) this.frame.setPointerCapture(start.pointerId);
      moving = true;
      this.frame.classList.add("moving");
      this.pan(event.clientX - clientX, event.clientY - clientY);
      ({ clientX, clientY } = event);
    };
    const end = (): void => {
      this.frame.classList.remove("moving");
      this.frame.removeEventListener("pointermove", move);
      this.frame.removeEventListener("pointerup", end);
      this.frame.removeEventListener("pointercancel", end);
      // The click at the end of a drag selects nothing.
      if (moving) this.frame.addEventListener("click", stop, { capture: true, once: true });
      window.setTimeout(() => this.frame.removeEventListener("click", stop, { capture: true }));
    };
    const stop = (event: Event): void => event.stopPropagation();
    this.frame.addEventListener("pointermove", move);
    this.frame.addEventListener("pointerup", end);
    this.frame.addEventListener("pointercancel", end);
  }

  private apply(): void {
    this.content.setAttribute("transform", `translate(${this.x} ${this.y}) scale(${this.scale})`);
    this.frame.classList.toggle("far", this.scale < 0.4);
  }
}
