// A sortable table. On a narrow screen its rows become cards; explicit roles keep it a table for screen readers.

import { h, replace_children, type Child } from "../lib/dom.ts";
import { language, t } from "../lib/words.ts";

export type Key = number | string | null;
export interface Column<Row> {
  name: string;
  title: string;
  cell: (row: Row) => Child;
  /** Key of the order; a column without one cannot be sorted. */
  key?: (row: Row) => Key;
  is_number?: boolean;
  /** The row's header: its first cell, and the heading of its card. */
  is_header?: boolean;
}
export interface Order {
  column: string;
  is_descending: boolean;
}
interface TableOptions<Row> {
  caption: string;
  columns: Column<Row>[];
  rows: Row[];
  order?: Order;
  on_order?: (order: Order) => void;
  page_size?: number;
}

/** Numbers by size, texts by the language's order; missing values are last in both directions. */
export function compare_keys(a: Key, b: Key, is_descending: boolean): number {
  if (a === null || b === null) return a === b ? 0 : a === null ? 1 : -1;
  const order = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), language(), { numeric: true });
  return is_descending ? -order : order;
}

export function sorted_rows<Row>(rows: Row[], columns: Column<Row>[], order: Order | undefined): Row[] {
  const key = columns.find((one) => one.name === order?.column)?.key;
  if (!order || !key) return rows;
  return [...rows].sort((a, b) => compare_keys(key(a), key(b), order.is_descending));
}

function row_element<Row>(columns: Column<Row>[], row: Row): HTMLElement {
  return h(
    "tr",
    { role: "row" },
    columns.map((column) => {
      const content = column.cell(row);
      return column.is_header
        ? h("th", { role: "rowheader", scope: "row" }, content)
        : h("td", { role: "cell", class: column.is_number ? "number" : null, "data-label": column.title }, h("div", { class: "cell" }, content));
    }),
  );
}

export function data_table<Row>(options: TableOptions<Row>): HTMLElement {
  const { columns } = options;
  let order = options.order;
  let shown = options.page_size ?? Infinity;
  const body = h("tbody", { role: "rowgroup" });
  const more = h("div", { class: "more" });
  const header_cells = new Map<string, HTMLElement>();

  const fill = (): void => {
    const rows = sorted_rows(options.rows, columns, order);
    replace_children(body, rows.slice(0, shown).map((row) => row_element(columns, row)));
    for (const column of columns) {
      const is_sorted = order?.column === column.name;
      header_cells.get(column.name)?.setAttribute("aria-sort", is_sorted ? (order!.is_descending ? "descending" : "ascending") : "none");
    }
    replace_children(
      more,
      rows.length > shown && [
        h("span", {}, t("{0} of {1} shown", shown, rows.length)),
        h("button", { type: "button", class: "button", on: { click: () => show_more() } }, t("Show more")),
      ],
    );
  };
  const show_more = (): void => {
    const first_new = shown;
    shown += options.page_size ?? 0;
    fill();
    const link = body.children[first_new]?.querySelector<HTMLElement>("a, button");
    link?.focus();
  };
  const sort_by = (column: Column<Row>, is_descending?: boolean): void => {
    const same = order?.column === column.name;
    order = { column: column.name, is_descending: is_descending ?? (same ? !order!.is_descending : Boolean(column.is_number)) };
    options.on_order?.(order);
    if (phone_sort) phone_sort.value = `${order.column} ${order.is_descending ? 1 : 0}`;
    fill();
  };

  const head = columns.map((column) => {
    const content = column.key
      ? h("button", { type: "button", class: "sort", on: { click: () => sort_by(column) } }, column.title, h("span", { class: "sort-mark", "aria-hidden": "true" }))
      : column.title;
    const cell = h("th", { role: "columnheader", scope: "col", class: column.is_number ? "number" : null }, content);
    if (column.key) header_cells.set(column.name, cell);
    return cell;
  });
  const phone_sort = make_phone_sort(columns, order, sort_by);
  const table = h(
    "table",
    { role: "table", class: "table" },
    h("caption", {}, options.caption),
    h("thead", { role: "rowgroup" }, h("tr", { role: "row" }, head)),
    body,
  );
  fill();
  return h("div", { class: "table-box" }, phone_sort && h("label", { class: "phone-sort" }, h("span", {}, t("Sort by")), phone_sort), table, more);
}

function make_phone_sort<Row>(columns: Column<Row>[], order: Order | undefined, sort_by: (column: Column<Row>, is_descending: boolean) => void): HTMLSelectElement | null {
  const sortable = columns.filter((one) => one.key);
  if (sortable.length === 0) return null;
  const choices = sortable.flatMap((one) =>
    [false, true].map((down) => {
      const direction = one.is_number ? (down ? t("high to low") : t("low to high")) : down ? t("Z to A") : t("A to Z");
      return h("option", { value: `${one.name} ${down ? 1 : 0}` }, `${one.title}, ${direction}`);
    }),
  );
  const select = h("select", { class: "field" }, choices);
  if (order) select.value = `${order.column} ${order.is_descending ? 1 : 0}`;
  select.addEventListener("change", () => {
    const [name, down] = select.value.split(" ");
    sort_by(sortable.find((one) => one.name === name)!, down === "1");
  });
  return select;
}

/** A closed section whose content is made when it is first opened: a table of a long curve is large. */
export function opened_later(title: string, make: () => Child): HTMLElement {
  const details = h("details", { class: "as-table" }, h("summary", {}, title));
  let is_made = false;
  details.addEventListener("toggle", () => {
    if (is_made || !details.open) return;
    is_made = true;
    details.append(h("div", {}, make()));
  });
  return details;
}

/** A plain table of texts: the alternative of a plot. */
export function plain_table(caption: string, titles: string[], rows: string[][]): HTMLElement {
  return h(
    "div",
    { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
    h(
      "table",
      { class: "plain-table" },
      h("caption", { class: "hidden" }, caption),
      h("thead", {}, h("tr", {}, titles.map((one) => h("th", { scope: "col" }, one)))),
      h("tbody", {}, rows.map((row) => h("tr", {}, row.map((text, index) => (index === 0 ? h("th", { scope: "row" }, text) : h("td", {}, text)))))),
    ),
  );
}
