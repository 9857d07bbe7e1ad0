// The time line: the position in the events of a run, live or in a replay.

import { button, html } from "./dom";
import { seconds } from "./run_marks";
import type { Recording } from "./recording";

const SPEEDS = [0.25, 1, 4, 16, 64];

/** Events a second at speed 1, if the run took no time, as runs of mock states do. */
const EVENTS_A_SECOND = 4;

export class Timeline {
  readonly element: HTMLElement;
  /** The number of events before the position. */
  position = 0;
  /** Called with the time of the run that is shown, in seconds; in a replay also between events. */
  timeShown: (t: number) => void = () => {};
  /** Whether the position moves with the run. */
  follows = true;
  private playing = false;
  /** The time of the replay: seconds of the run, or a number of events. */
  private clock = 0;
  private last = 0;
  private readonly slider = html("input", {
    type: "range", min: 0, max: 0, value: 0, step: 1, "aria-label": "Position in the run",
  });
  private readonly label = html("span", { class: "position" });
  private readonly play = button("Play", "Play", () => this.toggle(), "Play the recorded run (p)");
  private readonly latest = button("Latest event", "Latest", () => this.goTo(Infinity), "Go to the latest event");
  private readonly speed = html("select", { "aria-label": "Speed" },
    ...SPEEDS.map((each) => html("option", { value: each, selected: each === 1 }, `${each} ×`)));

  /** `moved` is called when the position has changed through the user or the replay. */
  constructor(
    private readonly recording: Recording,
    private readonly moved: () => void,
  ) {
    this.slider.addEventListener("input", () => this.goTo(Number(this.slider.value)));
    this.element = html("div", { class: "timeline", role: "group", "aria-label": "Time line" },
      button("First event", "First", () => this.goTo(0), "Go to the start"),
      button("Previous event", "‹", () => this.step(-1), "Previous event (,)"),
      this.play,
      button("Next event", "›", () => this.step(1), "Next event (.)"),
      this.latest, this.slider, this.label, this.speed,
    );
  }

  /** Follow the run after new events. */
  update(): void {
    if (this.follows) this.position = this.recording.events.length;
    this.position = Math.min(this.position, this.recording.events.length);
    this.show();
  }

  goTo(position: number): void {
    this.playing = false;
    this.move(position);
  }

  step(by: number): void {
    this.goTo(this.position + by);
  }

  /** Start or stop the replay; at the end it starts at the first event. */
  toggle(): void {
    this.playing = !this.playing;
    if (this.playing) {
      if (this.position >= this.recording.events.length) this.move(0);
      this.clock = this.timed ? this.timeAt(this.position) : this.position;
      this.last = performance.now();
      requestAnimationFrame((now) => this.tick(now));
    }
    this.show();
  }

  private tick(now: number): void {
    if (!this.playing) return;
    const passed = Math.min(1, (now - this.last) / 1000) * Number(this.speed.value);
    this.last = now;
    this.clock += this.timed ? passed : passed * EVENTS_A_SECOND;
    const next = this.timed ? this.recording.until(this.clock) : Math.floor(this.clock);
    if (next > this.position) this.move(next);
    if (this.position >= this.recording.events.length) this.playing = false;
    else requestAnimationFrame((then) => this.tick(then));
    this.show();
  }

  private get timed(): boolean {
    const [first, last] = this.recording.times;
    return last > first;
  }

  private timeAt(position: number): number {
    return this.recording.events[Math.max(0, position - 1)]?.t ?? this.recording.times[0];
  }

  private move(position: number): void {
    const end = this.recording.events.length;
    this.position = Math.max(0, Math.min(position, end));
    this.follows = this.position === end && !this.playing;
    this.show();
    this.moved();
  }

  private show(): void {
    const end = this.recording.events.length;
    this.slider.max = String(end);
    this.slider.value = String(this.position);
    const { dropped } = this.recording;
    const time = end ? `, ${seconds(this.position ? this.timeAt(this.position) : 0)} of ${seconds(this.recording.times[1])}` : "";
    this.label.textContent = `event ${this.position + dropped} of ${end + dropped}${time}`;
    this.slider.setAttribute("aria-valuetext", this.label.textContent);
    this.play.textContent = this.playing ? "Stop" : "Play";
    this.play.setAttribute("aria-label", this.playing ? "Stop the replay" : "Play");
    this.latest.setAttribute("aria-pressed", String(this.follows));
    if (end) this.timeShown(this.playing && this.timed ? this.clock : this.timeAt(this.position));
  }
}
