// A record of which a pixel shows many samples: a bar from the lowest to the highest of them in each column of pixels. A line that
// goes up and down in every column gives the same picture for many times the work.

import type uPlot from "uplot";

/** Least height of a bar, in pixels of the page: where lowest and highest are the same it is a line. */
const LINE = 1.25;

/** Draws series `k`. Its values are lowest and highest in turn, both at the time of their tile; null breaks it. */
export function drawSpans(plot: uPlot, k: number, fill: string): void {
  const { ctx, bbox } = plot;
  const times = plot.data[0];
  const values = plot.data[k]!;
  const scale = plot.series[k]!.scale!;
  const least = LINE * devicePixelRatio;
  const x = (at: number) => Math.round(plot.valToPos(times[at]!, "x", true));
  const y = (value: number) => plot.valToPos(value, scale, true);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = fill;
  /** The column of pixels that is gathered, from `left` on. */
  let column: { left: number; top: number; bottom: number } | null = null;
  const draw = (until: number) => {
    if (!column || until <= column.left) return;
    const more = Math.max(least - (column.bottom - column.top), 0) / 2;
    ctx.fillRect(column.left, column.top - more, until - column.left, column.bottom - column.top + 2 * more);
  };
  let width = 1;
  for (let at = 0; at + 1 < values.length; at += 1) {
    const [low, high] = [values[at], values[at + 1]];
    if (low == null || high == null) {
      if (column) draw(column.left + width);
      column = null;
      continue;
    }
    const left = x(at);
    let [top, bottom] = [y(high), y(low)];
    if (column) {
      // What lies between two tiles is drawn with the later of them.
      [top, bottom] = [Math.min(top, column.bottom), Math.max(bottom, column.top)];
      if (left > column.left) {
        width = left - column.left;
        draw(left);
        column = { left, top, bottom };
      } else {
        column = { left, top: Math.min(top, column.top), bottom: Math.max(bottom, column.bottom) };
      }
    } else {
      column = { left, top, bottom };
    }
    at += 1;
  }
  if (column) draw(column.left + width);
  ctx.restore();
}
