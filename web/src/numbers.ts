// Numbers as people read them. Nothing is computed here but digits.

import type { Shown } from "./api";

let units: Shown[] = [];

/** Tells which units are shown in place of those of SI. */
export function showIn(all: Shown[]): void {
  units = all;
}

/** The unit that is shown in place of one of SI, and by what numbers are multiplied for it. */
export function shownUnit(of: string): [unit: string, by: number] {
  const found = units.find((own) => own.si === of);
  return found ? [found.unit, found.by] : [unit(of), 1];
}

/** A number of SI in the unit that is shown. */
export function quantity(value: number, of: string): string {
  const [own, by] = shownUnit(of);
  return `${short(value * by)} ${own}`.trim();
}

/** Four significant digits. */
export function short(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [digits = "", power = ""] = value.toExponential(3).split("e");
    return `${digits}e${power.replace("+", "")}`.replace("-", "−").replace("e-", "e−");
  }
  return value.toPrecision(4).replace("-", "−");
}

/** A unit as it is printed. */
export function unit(text: string): string {
  return text === "1" ? "" : text.replaceAll("*", "·").replaceAll("^2", "²").replace("degC", "°C");
}

/** The unit that suits a length or an angle of this size, and by what it is multiplied for it; anything else as it is. */
export function lengthScale(of: string, size: number): [unit: string, by: number] {
  if (of === "m" && size > 0 && size < 1e-3) return ["µm", 1e6];
  const [own, by] = shownUnit(of);
  return of === "rad" && size > 0 && size < 1e-3 ? ["mdeg", 1e3 * by] : [own, by];
}

/** A length or an angle in the unit that suits its size. */
export function length(value: number, of: string): string {
  const [own, by] = lengthScale(of, Math.abs(value));
  return `${short(value * by)} ${own}`.trim();
}

/** A duration. */
export function seconds(value: number): string {
  if (value < 10) return `${value.toFixed(1)} s`;
  if (value < 90) return `${value.toFixed(0)} s`;
  return `${Math.floor(value / 60)} min ${Math.round(value % 60)} s`;
}

/** A number of bytes. */
export function bytes(value: number): string {
  const units = ["B", "kB", "MB", "GB"];
  let at = 0;
  let size = value;
  while (size >= 1000 && at < units.length - 1) {
    size /= 1000;
    at += 1;
  }
  return `${size >= 100 || at === 0 ? size.toFixed(0) : size.toFixed(1)} ${units[at]}`;
}
