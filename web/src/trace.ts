// Channels over time, one above the other with a common time axis. What is drawn comes as tiles of the pixels on the screen, so
// any length of log is drawn at once; while finer tiles are on their way the coarser ones are stretched.

import uPlot from "uplot";
import { binary, type Channel, type Stretch } from "./api";
import { color, onTheme } from "./colors";
import { h, put } from "./dom";
import { short, unit } from "./numbers";
import { drawSpans } from "./spans";

export interface Source { name: string; axis?: string | null; table?: boolean; run?: number }
export interface Band { from: number; to: number; kind: "crop" | "fit" | "validate" | "excluded" }
export interface Tick { at: number; kind: "note" | "warning"; text: string }
/** Channels that share one plot. */
export interface Panel { title: string; channels: Channel[] }

interface Options {
  source: Source;
  panels: Panel[];
  from: number;
  to: number;
  height: number;
  /** What is along the time axis, where that is no time in seconds. */
  over?: string;
  /** Called with the brushed stretch, null where it was taken back. */
  brushed?: (stretch: Stretch | null) => void;
  label: string;
}

const SMALLEST = 8;
const lines = uPlot.paths.linear!();

export class Trace {
  readonly element: HTMLElement;
  private plots: uPlot[] = [];
  private view: Stretch;
  private brush: Stretch | null = null;
  private bands: Band[] = [];
  private ticks: Tick[] = [];
  /** The question for tiles that is under way, and whether the view has moved since. */
  private asked: AbortController | null = null;
  private moved = false;
  /** The picture that is due with the next frame. */
  private due: number | null = null;
  /** The latest tiles, and whether they are drawn. */
  private last: ArrayBuffer | null = null;
  private drawn = true;
  /** Whether a tile is a sample, and not the span of many. */
  private single = true;
  private readonly stage = h("div", { class: "plots" });
  private readonly resize = new ResizeObserver(() => this.fit());
  private readonly noTheme: () => void;

  constructor(private readonly options: Options) {
    this.view = [options.from, options.to];
    this.element = h(
      "div",
      {
        class: "trace",
        tabindex: "0",
        role: "group",
        "aria-label": `${options.label}. Arrow keys move along the time, plus and minus zoom, Home shows all.`,
        onkeydown: (event: KeyboardEvent) => this.key(event),
      },
      this.stage,
    );
    this.build();
    this.resize.observe(this.element);
    this.noTheme = onTheme(() => this.build());
  }

  /** Lets go of everything. */
  end(): void {
    this.resize.disconnect();
    this.noTheme();
    this.asked?.abort();
    if (this.due !== null) cancelAnimationFrame(this.due);
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
  }

  /** What is shaded and marked. */
  mark(bands: Band[], ticks: Tick[]): void {
    this.bands = bands;
    this.ticks = ticks;
    for (const plot of this.plots) plot.redraw(false);
  }

  /** Brushes a stretch, or takes it back. */
  select(stretch: Stretch | null): void {
    this.brush = stretch;
    for (const plot of this.plots) plot.redraw(false);
    this.options.brushed?.(stretch);
  }

  get brushed(): Stretch | null { return this.brush; }
  get shown(): Stretch { return this.view; }

  /** Shows a part of the time. */
  show(from: number, to: number): void {
    const { from: first, to: last } = this.options;
    const whole = last - first;
    const width = Math.min(Math.max(to - from, whole * 1e-7), whole);
    const start = Math.min(Math.max(from, first), last - width);
    this.view = [start, start + width];
    this.ask();
    this.draw();
  }

  zoom(by: number, at = (this.view[0] + this.view[1]) / 2): void {
    const [from, to] = this.view;
    this.show(at - (at - from) * by, at + (to - at) * by);
  }

  private key(event: KeyboardEvent): void {
    if (event.target !== this.element) return;
    const [from, to] = this.view;
    const step = (to - from) / 5;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.show(from - step, to - step),
      ArrowRight: () => this.show(from + step, to + step),
      "+": () => this.zoom(0.5),
      "=": () => this.zoom(0.5),
      "-": () => this.zoom(2),
      Home: () => this.show(this.options.from, this.options.to),
      Escape: () => this.select(null),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  private build(): void {
    for (const plot of this.plots) plot.destroy();
    const { panels, height } = this.options;
    put(this.stage);
    this.plots = panels.map((panel, at) => this.plot(panel, height, at === panels.length - 1));
    if (this.last) this.apply(this.last);
    this.ask();
  }

  private plot(panel: Panel, height: number, last: boolean): uPlot {
    // The last is drawn above the others, and is the one that a panel is about.
    const line = (k: number) => `line-${panel.channels.length - k}`;
    const axis = { stroke: color("muted"), grid: { stroke: color("grid"), width: 1 }, ticks: { stroke: color("grid"), width: 1 }, font: "12px system-ui" };
    const own = panel.channels[0];
    const label = `${panel.title}${own && unit(own.unit) ? ` [${unit(own.unit)}]` : ""}`;
    const plot = new uPlot(
      {
        width: Math.max(this.element.clientWidth, 300),
        height: height + 10 + (last ? 34 : 0),
        cursor: { drag: { x: true, y: false, setScale: false }, sync: { key: `trace-${this.options.source.name}` }, points: { show: false } },
        legend: { show: false },
        padding: [18, 12, 0, 0],
        scales: { x: { time: false, auto: false, range: () => this.view }, y: {} },
        axes: [
          { ...axis, show: true, size: last ? 40 : 8, ...(last ? { label: this.options.over ?? "time [s]", labelSize: 18, labelFont: "12px system-ui" } : { values: () => [] }), space: 80 },
          { ...axis, size: 58, space: 15, values: (_: uPlot, values: number[]) => values.map((value) => axisNumber(value, values)) },
        ],
        series: [
          {},
          ...panel.channels.map((channel, k) => ({
            label: channel.name,
            stroke: color(line(k)),
            width: 1.25,
            points: { show: false },
            paths: (own: uPlot, at: number, from: number, to: number) => (this.single ? lines(own, at, from, to) : null),
          })),
        ],
        hooks: {
          drawClear: [(own) => this.shade(own)],
          drawSeries: [(own, k) => { if (!this.single) drawSpans(own, k, color(line(k - 1))); }],
          setSelect: [(own) => this.selected(own)],
          ready: [(own) => this.listen(own)],
        },
      },
      [[], ...panel.channels.map(() => [])] as unknown as uPlot.AlignedData,
      this.stage,
    );
    plot.root.setAttribute("role", "img");
    plot.root.setAttribute("aria-label", `${label} over ${this.options.over ?? "time"}`);
    plot.root.append(h("div", { class: "title" }, label));
    if (panel.channels.length > 1) {
      plot.root.append(h("div", { class: "legend" }, ...panel.channels.map((channel, k) => h("span", { class: `key key-${panel.channels.length - k}` }, channel.name))));
    }
    return plot;
  }

  private fit(): void {
    const width = Math.max(this.element.clientWidth, 300);
    for (const plot of this.plots) if (plot.width !== width) plot.setSize({ width, height: plot.height });
    this.ask();
  }

  /** Asks for the tiles of the view: at once, or where they are asked for already, when those are there. */
  private ask(): void {
    if (this.asked) this.moved = true;
    else void this.fetch();
  }

  private async fetch(): Promise<void> {
    const asked = new AbortController();
    this.asked = asked;
    this.moved = false;
    const { source, panels } = this.options;
    const channels = panels.flatMap((panel) => panel.channels);
    const [from, to] = this.view;
    // A little more than is seen, so that panning has something to show.
    const pixels = Math.round((this.plots[0]?.bbox.width ?? 1000) * 1.5);
    const beside = (to - from) / 4;
    try {
      const part = { from: from - beside, to: to + beside, pixels };
      this.last = await binary("/api/tiles", { ...source, channels: channels.map((channel) => channel.name).join(","), ...part }, asked.signal);
      this.drawn = false;
      this.draw();
    } catch (error) {
      if (error instanceof DOMException) return;
      throw error;
    } finally {
      this.asked = null;
      if (this.moved && !asked.signal.aborted) void this.fetch();
    }
  }

  /** Draws the view with the next frame. Tiles mostly come before it, so what is stretched is drawn only where they do not. */
  private draw(): void {
    this.due ??= requestAnimationFrame(() => {
      this.due = null;
      if (this.last && !this.drawn) this.apply(this.last);
      else for (const plot of this.plots) plot.setScale("x", { min: this.view[0], max: this.view[1] });
    });
  }

  private apply(buffer: ArrayBuffer): void {
    this.drawn = true;
    const { panels } = this.options;
    const [count = 0, , single = 0] = new Uint32Array(buffer, 0, 4);
    this.single = single === 1;
    const column = (at: number) => new Float64Array(buffer, 16 + 8 * count * at, count);
    const time = column(0);
    const breaks = gaps(time);
    let at = 1;
    for (const [k, panel] of panels.entries()) {
      const data: Drawn[] = [broken(single ? time : twice(time, time), breaks, single ? 1 : 2, (after) => (time[after - 1]! + time[after]!) / 2)];
      for (const _ of panel.channels) {
        data.push(broken(single ? column(at) : twice(column(at), column(at + 1)), breaks, single ? 1 : 2, () => null));
        at += single ? 1 : 2;
      }
      const plot = this.plots[k];
      if (!plot) continue;
      plot.setData(data as uPlot.AlignedData, false);
      plot.setScale("x", { min: this.view[0], max: this.view[1] });
    }
  }

  private listen(plot: uPlot): void {
    plot.over.addEventListener("wheel", (event) => {
      if (event.ctrlKey) return;
      event.preventDefault();
      const at = plot.posToVal(event.offsetX, "x");
      const width = this.view[1] - this.view[0];
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        const by = ((event.deltaX || event.deltaY) / 800) * width;
        this.show(this.view[0] + by, this.view[1] + by);
      } else {
        this.zoom(Math.exp(event.deltaY / 400), at);
      }
    }, { passive: false });
    plot.over.addEventListener("dblclick", () => this.show(this.options.from, this.options.to));
    plot.over.addEventListener("mousedown", (event) => {
      if (!event.shiftKey && event.button !== 1) return;
      // With shift the picture is moved instead of brushed.
      event.preventDefault();
      event.stopImmediatePropagation();
      const [from, to] = this.view;
      const scale = (to - from) / plot.over.clientWidth;
      const move = (moved: MouseEvent) => this.show(from - (moved.clientX - event.clientX) * scale, to - (moved.clientX - event.clientX) * scale);
      const up = () => {
        removeEventListener("mousemove", move);
        removeEventListener("mouseup", up);
      };
      addEventListener("mousemove", move);
      addEventListener("mouseup", up);
    }, { capture: true });
  }

  private selected(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width <= 0 || !this.options.brushed) return;
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    if (width < SMALLEST) this.select(null);
    else this.select([plot.posToVal(left, "x"), plot.posToVal(left + width, "x")]);
  }

  private shade(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const paint = (from: number, to: number, fill: string) => {
      const left = Math.max(plot.valToPos(from, "x", true), bbox.left);
      const right = Math.min(plot.valToPos(to, "x", true), bbox.left + bbox.width);
      if (right <= left) return;
      ctx.fillStyle = fill;
      ctx.fillRect(left, bbox.top, Math.max(right - left, 1), bbox.height);
    };
    ctx.save();
    for (const band of this.bands) paint(band.from, band.to, color(`band-${band.kind}`));
    if (this.brush) paint(this.brush[0], this.brush[1], color("band-brush"));
    for (const tick of this.ticks) {
      const x = plot.valToPos(tick.at, "x", true);
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      ctx.fillStyle = color(tick.kind === "warning" ? "warning" : "muted");
      ctx.fillRect(x - devicePixelRatio / 2, bbox.top, devicePixelRatio, bbox.height);
      ctx.beginPath();
      ctx.moveTo(x - 5 * devicePixelRatio, bbox.top);
      ctx.lineTo(x + 5 * devicePixelRatio, bbox.top);
      ctx.lineTo(x, bbox.top + 7 * devicePixelRatio);
      ctx.fill();
    }
    ctx.restore();
  }
}

/** Two arrays in turn: lowest and highest of each tile, drawn as one line. */
function twice(a: Float64Array, b: Float64Array): Float64Array {
  const out = new Float64Array(2 * a.length);
  for (let k = 0; k < a.length; k += 1) {
    out[2 * k] = a[k]!;
    out[2 * k + 1] = b[k]!;
  }
  return out;
}

type Drawn = Float64Array | (number | null)[];

/** Steps that are so many times the usual one are gaps, over which no line is drawn. */
const GAP = 10;

/** The places after a gap. */
function gaps(time: Float64Array): number[] {
  const steps = Float64Array.from({ length: Math.max(time.length - 1, 0) }, (_, k) => time[k + 1]! - time[k]!);
  const usual = steps.slice().sort()[steps.length >> 1] ?? 0;
  return [...steps.keys()].filter((k) => steps[k]! > GAP * usual).map((k) => k + 1);
}

/** Values with something put in at each gap; of each place there are `each`. */
function broken(values: Float64Array, breaks: number[], each: number, between: (after: number) => number | null): Drawn {
  if (!breaks.length) return values;
  const out: (number | null)[] = [];
  let from = 0;
  for (const after of breaks) {
    out.push(...values.subarray(each * from, each * after), between(after));
    from = after;
  }
  out.push(...values.subarray(each * from));
  return out;
}

/** A number at an axis: as many digits as tell it from its neighbours. */
export function axisNumber(value: number, all: number[]): string {
  const step = all.length > 1 ? Math.abs(all[1]! - all[0]!) : Math.abs(value);
  const size = Math.max(...all.map(Math.abs));
  if (value === 0) return "0";
  if (size >= 1e5 || (size < 1e-2 && size > 0)) return short(value).replace(/\.?0+e/, "e");
  let digits = 0;
  while (digits < 6 && Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) > 1e-6) digits += 1;
  return value.toFixed(digits).replace("-", "−");
}
