// Tables that a click on a column's title sorts.

/** What a cell is sorted by: its number, or its text with the numbers in it as numbers. */
function sortKey(cell) {
  const number = cell.dataset.sort;
  return number === undefined ? cell.textContent.trim() : Number(number);
}

const inWords = new Intl.Collator("en", { numeric: true });

function compareKeys(one, other) {
  if (typeof one === "number" && typeof other === "number") return one - other;
  // What has a number comes before what has none.
  if (typeof one !== typeof other) return typeof one === "number" ? -1 : 1;
  return inWords.compare(one, other);
}

function sortBy(table, column) {
  const title = table.tHead.rows[0].cells[column];
  const ascending = title.getAttribute("aria-sort") !== "ascending";
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  title.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const body = table.tBodies[0];
  const keyed = [...body.rows].map((row) => [sortKey(row.cells[column]), row]);
  keyed.sort(([one], [other]) => (ascending ? compareKeys(one, other) : compareKeys(other, one)));
  body.replaceChildren(...keyed.map(([, row]) => row));
}

function makeSortable(table) {
  [...table.tHead.rows[0].cells].forEach((title, column) => {
    title.querySelector("button").addEventListener("click", () => sortBy(table, column));
  });
}
