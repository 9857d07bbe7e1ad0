// The film of a recorded run, beside its log: the frame of the moment that the time line shows.

import { html } from "./dom";

/** A film of `run --record`: its media type, its frames per second of the run, and of the film. */
export interface FilmData {
  type: string;
  rate: number;
  speed: number;
}

/** Shows frame `index`, or the last one if the film is shorter; the number of the frame. */
type ShowFrame = (index: number) => Promise<number>;

export class Film {
  private readonly caption = html("figcaption", {}, "The film is loaded");
  private readonly frame = html("div", { class: "frame" });
  readonly element = html("figure", { class: "film", "aria-label": "Film of the run" }, this.frame, this.caption);
  private readonly film: Promise<ShowFrame | null>;
  private wanted = 0;
  private shown = -1;
  private busy = false;

  constructor(private readonly data: FilmData) {
    this.film = this.load();
    void this.update();
  }

  /** Show the frame of a time of the run, in seconds. */
  show(t: number): void {
    this.wanted = Math.max(0, Math.floor(t * this.data.rate + 1e-6));
    void this.update();
  }

  private async load(): Promise<ShowFrame | null> {
    try {
      const answer = await fetch("film");
      if (!answer.ok) throw new Error("the server has no film");
      const content = await answer.blob();
      return this.data.type === "image/gif" ? await this.gif(content) : await this.video(content);
    } catch (error) {
      this.caption.textContent = `The film cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
      return null;
    }
  }

  /** Show the latest frame that is wanted; those that were wanted in the meantime are left out. */
  private async update(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    const film = await this.film;
    while (film && this.shown !== this.wanted) {
      const index = this.wanted;
      const frame = await film(index);
      this.shown = index;
      this.element.dataset["frame"] = String(frame);
      this.caption.textContent = `Film at ${(frame / this.data.rate).toFixed(1)} s`;
    }
    this.busy = false;
  }

  private async gif(content: Blob): Promise<ShowFrame> {
    if (typeof ImageDecoder === "undefined") {
      throw new Error("this browser shows single frames of .mp4 only, not of .gif");
    }
    const decoder = new ImageDecoder({ data: await content.arrayBuffer(), type: this.data.type });
    await decoder.tracks.ready;
    await decoder.completed;
    const starts = await this.starts(decoder);
    if (starts.length < 2) throw new Error("it has no image");
    const last = starts.pop()! - 1;
    const canvas = html("canvas", {});
    this.frame.replaceChildren(canvas);
    return async (wanted) => {
      const index = Math.min(wanted, last);
      const { image } = await decoder.decode({ frameIndex: starts.filter((each) => each <= index).length - 1 });
      if (canvas.width !== image.displayWidth) canvas.width = image.displayWidth;
      if (canvas.height !== image.displayHeight) canvas.height = image.displayHeight;
      canvas.getContext("2d")?.drawImage(image, 0, 0);
      image.close();
      return index;
    };
  }

  /** The number of the first frame that each image of a GIF stands for, and their count: equal frames are
   * one image, which is shown longer. The last frame is shown for two seconds (`Gif` in sim/video.py). */
  private async starts(decoder: ImageDecoder): Promise<number[]> {
    const count = decoder.tracks.selectedTrack?.frameCount ?? 0;
    const frame = Math.floor(1000 / this.data.speed);
    const starts = [0];
    for (let index = 0; index < count; index += 1) {
      const { image } = await decoder.decode({ frameIndex: index });
      const shown = (image.duration ?? 0) / 1000 - (index === count - 1 ? 2000 - frame : 0);
      image.close();
      starts.push(starts[index]! + Math.max(1, Math.round(shown / frame)));
    }
    return starts;
  }

  private async video(content: Blob): Promise<ShowFrame> {
    const video = html("video", { muted: true, playsinline: true, preload: "auto" });
    this.frame.replaceChildren(video);
    const failed = (): Error => new Error("this browser cannot play it");
    await new Promise<void>((resolve, reject) => {
      video.addEventListener("loadeddata", () => resolve(), { once: true });
      video.addEventListener("error", () => reject(failed()), { once: true });
      video.src = URL.createObjectURL(content);
    });
    return async (wanted) => {
      const last = Math.max(0, Math.round(video.duration * this.data.speed) - 1);
      const index = Math.min(wanted, last);
      await new Promise<void>((resolve) => {
        video.addEventListener("seeked", () => resolve(), { once: true });
        // The middle of a frame: its ends are those of its neighbours too.
        video.currentTime = (index + 0.5) / this.data.speed;
      });
      return index;
    };
  }
}
