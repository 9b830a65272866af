// Points of one channel over another, such as the force over the velocity: what is brushed, drawn as it was logged.

import uPlot from "uplot";
import { color, onTheme } from "./colors";
import { h, put } from "./dom";
import { axisNumber } from "./trace";

/** Points, each with the ends of its interval where it has one. */
export interface Points { x: Float64Array; y: Float64Array; low?: Float64Array; high?: Float64Array }

export class PointMap {
  readonly element: HTMLElement;
  private plot: uPlot | null = null;
  private points: Points = { x: new Float64Array(), y: new Float64Array() };
  /** What a model makes of them, in their order. */
  private model: Points | null = null;
  private readonly stage = h("div", {});
  private readonly keys = h("div", { class: "keys" });
  private readonly resize = new ResizeObserver(() => this.build());
  private readonly noTheme: () => void;

  /** `names` are those of the points and of what is drawn over them: a line, or as `dots` points too. */
  constructor(private readonly title: string, private labels: [x: string, y: string], private readonly height: number, private readonly names = ["measured", "model"], private readonly dots = false) {
    this.element = h("figure", { class: "map" }, h("figcaption", {}, title, this.keys), this.stage);
    this.resize.observe(this.element);
    this.noTheme = onTheme(() => this.build());
  }

  end(): void {
    this.resize.disconnect();
    this.noTheme();
    this.plot?.destroy();
  }

  draw(points: Points, labels = this.labels, model: Points | null = null): void {
    this.points = points;
    this.model = model;
    this.labels = labels;
    this.build();
  }

  private build(): void {
    this.plot?.destroy();
    put(this.stage);
    const width = this.element.clientWidth;
    if (width < 50) return;
    const axis = { stroke: color("muted"), grid: { stroke: color("grid"), width: 1 }, ticks: { stroke: color("grid"), width: 1 }, font: "12px system-ui", labelSize: 18, labelFont: "12px system-ui" };
    put(this.keys, ...(this.model ? [h("span", { class: "key key-2" }, this.names[0]), h("span", { class: "key key-1" }, this.names[1])] : []));
    const [low, high] = extent(this.points.x, this.model?.x);
    const [least, most] = extent(this.points.y, this.points.low, this.points.high, this.model?.y);
    const values = (_: uPlot, all: number[]) => all.map((value) => axisNumber(value, all));
    this.plot = new uPlot(
      {
        width,
        height: this.height,
        legend: { show: false },
        cursor: { show: false },
        padding: [8, 14, 0, 0],
        scales: { x: { time: false, range: [low, high] }, y: { range: [least, most] } },
        axes: [
          { ...axis, label: this.labels[0], size: 34, values, space: 70 },
          { ...axis, label: this.labels[1], size: 58, values },
        ],
        series: [{}, { paths: () => null, points: { show: false } }],
        hooks: { draw: [(own) => this.draws(own)] },
      },
      [[low, high], [least, most]],
      this.stage,
    );
    this.plot.root.setAttribute("role", "img");
    this.plot.root.setAttribute("aria-label", `${this.title}: ${this.labels[1]} over ${this.labels[0]}, ${this.points.x.length} points`);
  }

  private draws(plot: uPlot): void {
    this.scatter(plot, this.points, this.model ? "line-2" : "line-1");
    if (this.model && this.dots) this.scatter(plot, this.model, "line-1");
    else if (this.model) this.line(plot, this.model);
  }

  private scatter(plot: uPlot, points: Points, shade: string): void {
    const { ctx } = plot;
    // A few points are means, which a model drawn over them must not hide.
    const size = Math.max((points.x.length < 100 ? 5 : 1.5) * devicePixelRatio, 1);
    ctx.save();
    ctx.globalAlpha = points.x.length > 2000 ? 0.45 : 0.8;
    ctx.fillStyle = color(shade);
    for (let k = 0; k < points.x.length; k += 1) {
      const x = points.x[k]!;
      const y = points.y[k]!;
      if (Number.isNaN(x) || Number.isNaN(y)) continue;
      const [low, high] = [points.low?.[k] ?? y, points.high?.[k] ?? y].map((end) => plot.valToPos(end, "y", true)) as [number, number];
      if (low > high) ctx.fillRect(plot.valToPos(x, "x", true) - devicePixelRatio / 2, high, devicePixelRatio, low - high);
      ctx.fillRect(plot.valToPos(x, "x", true) - size / 2, plot.valToPos(y, "y", true) - size / 2, size, size);
    }
    ctx.restore();
  }

  private line(plot: uPlot, { x, y }: Points): void {
    const { ctx } = plot;
    ctx.save();
    ctx.strokeStyle = color("line-1");
    ctx.lineWidth = 1.25 * devicePixelRatio;
    ctx.lineJoin = "round";
    ctx.beginPath();
    let whole = false;
    for (let k = 0; k < x.length; k += 1) {
      const there = !Number.isNaN(x[k]!) && !Number.isNaN(y[k]!);
      if (there) ctx[whole ? "lineTo" : "moveTo"](plot.valToPos(x[k]!, "x", true), plot.valToPos(y[k]!, "y", true));
      whole = there;
    }
    ctx.stroke();
    ctx.restore();
  }
}

/** Ends of an axis, a little beyond what is drawn. */
function extent(...all: (Float64Array | undefined)[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const values of all) {
    for (const value of values ?? []) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (!(high >= low)) return [0, 1];
  const beside = 0.05 * (high - low) || Math.abs(high) || 1;
  return [low - beside, high + beside];
}
