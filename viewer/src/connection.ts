// The stream of messages from `smachac view` and `smachac run --view`, and the actions sent back.

import type { Finding, Model, Round } from "./model";
import type { TraceEvent } from "./run_state";
import type { SimulationStatus } from "./simulation";

export interface Place {
  path: string;
  outcome: string | null;
  /** Each of the tries or items of the state. */
  round: Round | null;
}

/** A state that waits: before its start, or after its end with `outcome`. */
export interface Waiting extends Place {
  outcomes: string[];
}

/** What the run can be made to do now. */
export interface ControlStatus {
  paused: boolean;
  stopping: boolean;
  ended: boolean;
  at: Waiting[];
  breakpoints: Place[];
}

export type Message =
  | { kind: "model"; model: Model }
  | { kind: "report"; broken: boolean; outdated: boolean; findings: Finding[] }
  | { kind: "trace"; events: TraceEvent[] }
  | { kind: "dropped"; count: number }
  | { kind: "source"; waits: string }
  | ({ kind: "simulation" } & SimulationStatus)
  | ({ kind: "control" } & ControlStatus);

export interface Listener {
  /** A stream begins: everything is sent again, from the first event. */
  opened(): void;
  received(message: Message): void;
  /** The stream is interrupted; the browser tries again. */
  interrupted(): void;
  /** The server has sent everything and ends. */
  ended(): void;
}

export function connect(listener: Listener): void {
  const source = new EventSource("events");
  source.addEventListener("open", () => listener.opened());
  source.addEventListener("message", (message) => listener.received(JSON.parse(message.data as string) as Message));
  source.addEventListener("error", () => listener.interrupted());
  source.addEventListener("end", () => {
    source.close();
    listener.ended();
  });
}

const TOKEN = "smachac-token";

/** The token in the address. It is moved to the memory of the tab, so that no one reads it there. */
export function takeToken(): string | null {
  const parameters = new URLSearchParams(location.hash.slice(1));
  const given = parameters.get("token");
  if (given === null) return sessionStorage.getItem(TOKEN);
  sessionStorage.setItem(TOKEN, given);
  parameters.delete("token");
  const rest = parameters.toString().replaceAll("%2F", "/");
  history.replaceState(null, "", rest ? `#${rest}` : location.pathname + location.search);
  return given;
}

/** What the server answers to an action, or the reason why it was refused. */
export type Answer<T> = { ok: true; content: T } | { ok: false; reason: string };

export async function post<T>(token: string, path: string, body: object): Promise<Answer<T>> {
  try {
    const answer = await fetch(path, {
      method: "POST",
      headers: { "Content-Type": "application/json", "X-Smachac-Token": token },
      body: JSON.stringify(body),
    });
    const content = (await answer.json()) as T & { error?: string };
    return answer.ok ? { ok: true, content } : { ok: false, reason: content.error ?? answer.statusText };
  } catch {
    return { ok: false, reason: "the server does not answer" };
  }
}

/** Do an action; the reason if it was refused, else null. */
export async function act(token: string, path: string, body: object): Promise<string | null> {
  const answer = await post(token, path, body);
  return answer.ok ? null : answer.reason;
}
