"""Tables of a benchmark, once for programs and once for people."""
import csv


def write_table(folder, name, columns, rows, text):
    """Writes rows (dicts) as NAME.csv and NAME.md; columns: key and title; text(key, value): a cell."""
    with open(folder / f"{name}.csv", "w", newline="") as out:
        table = csv.DictWriter(out, list(columns))
        table.writeheader()
        table.writerows(rows)
    with open(folder / f"{name}.md", "w") as out:
        out.write("| " + " | ".join(columns.values()) + " |\n" + "|---" * len(columns) + "|\n")
        for row in rows:
            cells = (text(key, row.get(key)).replace("|", "\\|") for key in columns)
            out.write("| " + " | ".join(cells) + " |\n")
