// A contour in its plane: the reference, and the deviations of runs from it as the server magnified them.

import { h, put } from "./dom";
import { lengthScale, short } from "./numbers";

export interface Path { x: (number | null)[]; y: (number | null)[] }
export interface PlaneData { magnified: number; bar: number; middle: [number, number]; size: number; reference: Path; runs: Path[] }

/** Side of the picture, in its own units. */
const SIDE = 400;
/** How much of it the contour takes. */
const TAKEN = 0.7;
const SVG = "http://www.w3.org/2000/svg";

export class Plane {
  readonly element: HTMLElement;
  private readonly keys = h("div", { class: "keys" });
  private readonly title = h("span", {});
  private readonly stage = h("div", { class: "plane" });

  constructor() {
    this.element = h("figure", { class: "map" }, h("figcaption", {}, this.title, this.keys), this.stage);
  }

  /** Runs by their names, the first without compensation. */
  draw(plane: PlaneData, names: string[], unit: string): void {
    const scale = (TAKEN * SIDE) / plane.size;
    const place = (value: number, axis: 0 | 1) => {
      const off = scale * (value - plane.middle[axis]);
      return (SIDE / 2 + (axis === 0 ? off : -off)).toFixed(2);
    };
    const line = (path: Path, kind: string) => svg("path", { class: kind, d: steps(path, place) });
    // Colours as in the lines over the time: the last is the first.
    const last = plane.runs.length;
    const picture = svg("svg", { viewBox: `0 0 ${SIDE} ${SIDE}`, role: "img", "aria-label": `Contour with deviations magnified ${short(plane.magnified)} times: ${names.join(", ")}` });
    picture.append(line(plane.reference, "reference"), ...plane.runs.map((run, k) => line(run, `run-${last - k}`)));
    for (const [text, x, y] of [["x", SIDE - 14, SIDE / 2 + 4], ["y", SIDE / 2, 16]] as const) {
      const label = svg("text", { x: String(x), y: String(y) });
      label.textContent = text;
      picture.append(label);
    }
    const label = svg("text", { x: "10", y: String(SIDE - 18) });
    const [barUnit, by] = lengthScale(unit, plane.bar);
    label.textContent = `${Number((plane.bar * by).toPrecision(4))} ${barUnit}`;
    picture.append(svg("path", { class: "bar", d: `M10 ${SIDE - 10}h${(scale * plane.magnified * plane.bar).toFixed(2)}` }), label);
    put(this.title, `Deviations × ${plane.magnified}`);
    put(this.keys, ...names.map((name, k) => h("span", { class: `key key-${last - k}` }, name)));
    put(this.stage, picture);
  }
}

function svg(tag: string, attributes: Record<string, string>): SVGElement {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

function steps({ x, y }: Path, place: (value: number, axis: 0 | 1) => string): string {
  let out = "";
  let whole = false;
  for (let k = 0; k < x.length; k += 1) {
    const [a, b] = [x[k], y[k]];
    const there = a !== null && a !== undefined && b !== null && b !== undefined;
    if (there) out += `${whole ? "L" : "M"}${place(a, 0)} ${place(b, 1)}`;
    whole = there;
  }
  return out;
}
