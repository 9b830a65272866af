// The command line that does what the page shows, to copy.

import { post } from "./api";
import { attempt, h, put, say } from "./dom";

export function commandLine(label = "The same on the command line"): { element: HTMLElement; show: (text: string) => void; of: (asked: unknown, path?: string) => void } {
  const code = h("code", { tabindex: "0" });
  const copy = h("button", {
    class: "quiet",
    onclick: () => void attempt(async () => {
      await navigator.clipboard.writeText(code.textContent ?? "");
      say("copied");
    }),
  }, "Copy");
  const element = h("div", { class: "command", role: "group", "aria-label": label }, h("span", { class: "prompt", "aria-hidden": "true" }, "$"), code, copy);
  let last = 0;
  return {
    element,
    show: (text) => put(code, text),
    of: (asked, path = "/api/command") => {
      last += 1;
      const own = last;
      void post<string>(path, asked).then((text) => { if (own === last) put(code, text); }).catch(() => { if (own === last) put(code, ""); });
    },
  };
}
