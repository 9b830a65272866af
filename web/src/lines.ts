// Lines over a common time, each with times of its own: drawn anew at every change, so nothing is built twice.

import uPlot from "uplot";
import { color, onTheme } from "./colors";
import { h, put } from "./dom";
import { lengthScale } from "./numbers";
import { axisNumber } from "./trace";

export interface Line { name: string; x: number[]; y: number[] }

export class Lines {
  readonly element: HTMLElement;
  private plot: uPlot | null = null;
  private lines: Line[] = [];
  private unit = "";
  private readonly stage = h("div", {});
  private readonly heading = h("span", {});
  private readonly keys = h("div", { class: "keys" });
  private readonly resize = new ResizeObserver(() => this.build());
  private readonly noTheme: () => void;

  constructor(private title: string, private readonly height: number, private readonly nothing: string) {
    this.element = h("figure", { class: "map lines" }, h("figcaption", {}, this.heading, this.keys), this.stage);
    this.called(title);
    this.resize.observe(this.element);
    this.noTheme = onTheme(() => this.build());
  }

  called(title: string): void {
    this.title = title;
    put(this.heading, title);
  }

  end(): void {
    this.resize.disconnect();
    this.noTheme();
    this.plot?.destroy();
  }

  /** Errors in this SI unit, over the time. */
  draw(lines: Line[], unit: string): void {
    const same = lines.length === this.lines.length && unit === this.unit && lines.every((line, k) => line.name === this.lines[k]?.name);
    this.lines = lines;
    this.unit = unit;
    if (same && this.plot) this.plot.setData(this.data());
    else this.build();
  }

  private data(): uPlot.AlignedData {
    const tables = this.lines.map((line) => [line.x, line.y] as uPlot.AlignedData);
    return tables.length > 1 ? uPlot.join(tables) : (tables[0] ?? [[], []]);
  }

  private build(): void {
    this.plot?.destroy();
    this.plot = null;
    put(this.stage);
    const width = this.element.clientWidth - 10;
    put(this.keys);
    if (!this.lines.length) put(this.stage, h("p", { class: "muted nothing" }, this.nothing));
    if (width < 50 || !this.lines.length) return;
    const line = (k: number) => `line-${this.lines.length - k}`;
    put(this.keys, ...this.lines.map((own, k) => h("span", { class: `key key-${this.lines.length - k}` }, own.name)));
    const axis = { stroke: color("muted"), grid: { stroke: color("grid"), width: 1 }, ticks: { stroke: color("grid"), width: 1 }, font: "12px system-ui", labelSize: 18, labelFont: "12px system-ui" };
    this.plot = new uPlot(
      {
        width,
        height: this.height,
        legend: { show: false },
        cursor: { show: false },
        padding: [8, 14, 0, 0],
        scales: { x: { time: false } },
        axes: [
          { ...axis, label: "time [s]", size: 34, values: (_: uPlot, all: number[]) => all.map((value) => axisNumber(value, all)), space: 70 },
          {
            ...axis,
            label: () => `error [${lengthScale(this.unit, this.largest())[0]}]`,
            size: 58,
            values: (_: uPlot, all: number[]) => {
              const scaled = all.map((value) => value * lengthScale(this.unit, this.largest())[1]);
              return scaled.map((value) => axisNumber(value, scaled));
            },
          },
        ],
        series: [{}, ...this.lines.map((own, k) => ({ label: own.name, stroke: color(line(k)), width: 1.25, points: { show: false }, spanGaps: true }))],
      },
      this.data(),
      this.stage,
    );
    this.plot.root.setAttribute("role", "img");
    this.plot.root.setAttribute("aria-label", `${this.title}: ${this.lines.map((own) => own.name).join(", ")}`);
  }

  private largest(): number {
    const { min = 0, max = 0 } = this.plot?.scales["y"] ?? {};
    return Math.max(Math.abs(min ?? 0), Math.abs(max ?? 0));
  }
}
