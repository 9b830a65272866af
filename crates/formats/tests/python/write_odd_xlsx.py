"""Writes workbooks that are odd: cells TRUE among numbers, hidden sheets before the one that is shown and alone, too many columns.

    python write_odd_xlsx.py FOLDER
"""

import sys
from pathlib import Path

from openpyxl import Workbook

folder = Path(sys.argv[1])


def rows(sheet, count, column=lambda i: 0.1 * i):
    sheet.append(["Time [s]", "Position [mm]", "enabled"])
    for i in range(count):
        sheet.append([0.001 * i, column(i), i > 2])


book = Workbook()
rows(book.active, 20, lambda i: True if i in (4, 9) else 0.1 * i)
book.save(folder / "booleans.xlsx")

book = Workbook()
book.active.title = "old"
rows(book.active, 20, lambda i: -1.0)
book.active.sheet_state = "hidden"
rows(book.create_sheet("run"), 20)
book.active = 1
book.save(folder / "hidden.xlsx")

book = Workbook()
book.active.title = "cover"
book.active.append(["a title alone"])
rows(book.create_sheet("raw"), 20)
book["raw"].sheet_state = "veryHidden"
book.save(folder / "only_hidden.xlsx")

book = Workbook()
book.active.append([float(i) for i in range(5000)])
book.active.append([float(i) for i in range(5000)])
book.save(folder / "wide.xlsx")
