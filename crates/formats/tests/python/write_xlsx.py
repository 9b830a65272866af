"""Writes workbooks with openpyxl, and beside each one the truth.

Usage: python write_xlsx.py FOLDER

The truth is what openpyxl reads from the file.
"""

import datetime

import numpy as np
from openpyxl import Workbook, load_workbook

from truth import Truth, bits, folder


def finite(n):
    """Doubles of random bits that a cell can have."""
    values = bits(3 * n)
    values[values == 0] = 0.0
    return values[np.isfinite(values)][:n]


def check(truth, sheet, first_row, names, skipped=()):
    """Columns as openpyxl reads them; a date is in seconds from the first."""
    rows = list(load_workbook(truth.path, data_only=True)[sheet].iter_rows(min_row=first_row, values_only=True))
    for name, cells in zip(names, zip(*rows)):
        dates = [cell for cell in cells if isinstance(cell, (datetime.datetime, datetime.time))]
        if name in skipped:
            truth.skipped(name)
        elif dates:
            micro = [np.nan if c is None else (c - dates[0]) // datetime.timedelta(microseconds=1) for c in cells]
            truth.column(name, np.array(micro) / 1e6)
        else:
            truth.column(name, [np.nan if c is None or isinstance(c, str) else float(c) for c in cells])


def table(name, write_only):
    truth = Truth(name)
    book = Workbook(write_only=write_only)
    sheet = book.create_sheet("Axis 3 & more") if write_only else book.active
    n = 400
    q, t = finite(n), np.arange(n) / 1000
    start = datetime.datetime(2026, 8, 1, 12)
    sheet.append(["Time [s]", "q <1>", "Torque [N m]", "mode", "on", "at", "whole"])
    for i in range(n):
        torque = None if i % 5 == 3 else i / 7
        row = [t[i], q[i], torque, "hold", i % 2 == 0, start + datetime.timedelta(milliseconds=10 * i), i - 100]
        sheet.append(row)
    title = book.create_sheet("notes")
    title.append(["nothing but words"])
    book.save(truth.path)
    check(truth, load_workbook(truth.path).sheetnames[0], 2, ["Time", "q <1>", "Torque", "mode", "on", "at", "whole"], ["mode"])
    truth.skipped("sheet notes")
    truth.write()


def titled(name):
    """A sheet of words, one of settings, then one with titles, units in a row, an error, a formula, and columns that begin late."""
    truth = Truth(name)
    book = Workbook()
    book.active.title = "about"
    book.active.append(["a drive"])
    settings = book.create_sheet("settings")
    for row in (["test stand", 7], ["operator", "B"], ["force constant", 35.5], ["stroke", 120]):
        settings.append(row)
    sheet = book.create_sheet("data")
    sheet["A1"] = "Recorded on axis 3"
    sheet.append(["Time", "Position", "Force"])
    sheet.append(["s", "mm", "N"])
    for i in range(50):
        sheet.append([i / 1000, i * 0.1, "#DIV/0!" if i == 7 else 1 / (i + 1)])
    book.save(truth.path)
    check(truth, "data", 4, ["Time", "Position", "Force"])
    truth.skipped("sheet about")
    truth.skipped("sheet settings")
    truth.write()


def commas(name):
    """Numbers that are texts with a decimal comma, dates that are texts, and a column of numbers."""
    truth = Truth(name)
    book = Workbook()
    sheet = book.active
    sheet.append(["sample time in ms", "0,25"])
    sheet.append(["at", "Position [mm]", "Force [N]", "whole"])
    n = 60
    position, force = np.arange(n) / 7 - 3, np.sin(np.arange(n)) * 1e-3
    start = datetime.datetime(2024, 11, 26, 12)
    for i in range(n):
        at = (start + datetime.timedelta(milliseconds=i)).strftime("%d.%m.%Y %H:%M:%S,%f")[:-3]
        comma = lambda number: repr(float(number)).replace(".", ",")
        sheet.append([at, comma(position[i]), float(force[i]), str(i)])
    book.save(truth.path)
    truth.column("at", np.arange(n) / 1000)
    truth.column("Position", position)
    truth.column("Force", [row[2] for row in load_workbook(truth.path).active.iter_rows(min_row=3, values_only=True)])
    truth.column("whole", np.arange(n, dtype=float))
    truth.write()


commas("commas.xlsx")
table("table.xlsx", False)
table("written.xlsx", True)
titled("titled.xlsx")
