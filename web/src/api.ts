// What is asked of the server. Every request carries the key of this session, which only a page of this origin can read.

const KEY = "stiction-key";

/** A log that a result, a model or a study comes from: its name, or its path where it is not in the folder, and its SHA-256 then. */
export interface Source { name: string; sha256: string }
export interface Entry { name: string; kind: string; bytes: number; modified: number; of: Source[] }
/** A unit that is shown in place of that of SI, and the number of it in one of SI. */
export interface Shown { si: string; unit: string; by: number }
export interface Workspace { folder: string; version: string; files: Entry[]; units: Shown[] }
export interface Column { number: number; name: string; role: string | null; unit: string; reason: string; assumed: boolean; range: Stretch | null }
export interface Channel { name: string; unit: string; derived: boolean }
export interface Found { code: string; severity: string; message: string; at_s: number | null }
export interface LeftOut { code: string; from_s: number; to_s: number }
export type Stretch = [from: number, to: number];
export interface Marks { crop: Stretch | null; fit: Stretch[]; validate: Stretch[]; validate_all: boolean }
export interface About {
  sha256: string; samples: number; rate_hz: number; seconds: number; motion: string; force_unit: string; detected: string[];
  findings: Found[]; excluded: LeftOut[]; columns: Column[]; channels: Channel[]; span: Stretch; over: string; marks: Marks; refused: string | null;
}
/** The axis file that a log is read with, and one that is there and is of another log. */
export interface Which { axis: string | null; not: string | null }
export interface Job {
  id: number; kind: string; command: string; about: string; state: "running" | "stopping" | "done" | "failed";
  stage: string | null; fraction: number; seconds: number; left: number | null; error_percent: number | null;
  verdict: "trustworthy" | "not-trustworthy" | "interrupted" | null; text: string; folder: string | null;
  written: string[]; json: unknown;
}

/** The session is over, or there never was one. */
export class NoSession extends Error {}

async function refusal(response: Response): Promise<Error> {
  const body: unknown = await response.json().catch(() => null);
  const said = (body as { error?: { message?: string } } | null)?.error?.message;
  const message = said ?? `${response.status} ${response.statusText}`;
  return response.status === 403 && message.includes("session") ? new NoSession(message) : new Error(message);
}

async function request(path: string, init: RequestInit = {}): Promise<Response> {
  const headers = new Headers(init.headers);
  headers.set("x-stiction-key", localStorage.getItem(KEY) ?? "");
  const response = await fetch(path, { ...init, headers });
  if (!response.ok) throw await refusal(response);
  return response;
}

/** Exchanges the token of the address, which is good once, for the session, and takes it out of the address. */
export async function begin(): Promise<void> {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (!token) return;
  history.replaceState(null, "", location.pathname);
  const response = await fetch("/api/session", {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify({ token }),
  });
  if (!response.ok) {
    const refused = await refusal(response);
    // An address that was opened before needs no token where the session is there.
    await get("/api/workspace").catch(() => { throw refused; });
    return;
  }
  localStorage.setItem(KEY, ((await response.json()) as { key: string }).key);
}

function query(values: Record<string, string | number | boolean | null | undefined>): string {
  const out = new URLSearchParams();
  for (const [name, value] of Object.entries(values)) if (value !== null && value !== undefined) out.set(name, String(value));
  return out.toString();
}

export async function get<T>(path: string, values: Parameters<typeof query>[0] = {}, signal?: AbortSignal): Promise<T> {
  return (await (await request(`${path}?${query(values)}`, { signal: signal ?? null })).json()) as T;
}

export async function post<T>(path: string, body: unknown, method = "POST"): Promise<T> {
  const response = await request(path, { method, headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
  return (await response.json()) as T;
}

export async function binary(path: string, values: Parameters<typeof query>[0], signal?: AbortSignal): Promise<ArrayBuffer> {
  return (await request(`${path}?${query(values)}`, { signal: signal ?? null })).arrayBuffer();
}

/** Sends a file; the browser streams it. */
export async function upload(file: File, replace: boolean): Promise<void> {
  await request(`/api/upload?${query({ name: file.name, replace })}`, { method: "POST", body: file });
}

/** Opens a file in a tab, or saves a file or a folder. */
export async function open(name: string, how: "show" | "save" | "zip"): Promise<void> {
  const address = await post<string>("/api/ticket", { name, how });
  const link = document.createElement("a");
  link.href = address;
  link.rel = "noopener";
  if (how === "show") link.target = "_blank";
  else link.download = "";
  link.click();
}

/** All work, now and whenever it changes, until the server is gone; then once a second again. */
export async function watch(seen: (job: Job) => void, gone: (why: string | null) => void): Promise<never> {
  for (;;) {
    try {
      const response = await request("/api/events");
      gone(null);
      const reader = response.body!.pipeThrough(new TextDecoderStream()).getReader();
      let rest = "";
      for (;;) {
        const { value, done } = await reader.read();
        if (done) break;
        rest += value;
        const messages = rest.split("\n\n");
        rest = messages.pop() ?? "";
        for (const message of messages) {
          const data = message.split("\n").filter((line) => line.startsWith("data:"));
          if (data.length) seen(JSON.parse(data.map((line) => line.slice(5)).join("\n")) as Job);
        }
      }
      gone("The server has ended. Start stiction studio again and open the address that it prints.");
    } catch (error) {
      gone(error instanceof NoSession ? error.message : "The server has ended. Start stiction studio again and open the address that it prints.");
    }
    await new Promise((done) => setTimeout(done, 1000));
  }
}
