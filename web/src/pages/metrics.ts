// Distribution of a metric in each group.

import { get, path_with } from "../lib/api.ts";
import { h, replace_children, type Child } from "../lib/dom.ts";
import { number_text, sentence, unit_text, with_unit } from "../lib/format.ts";
import { write_query, type PageContext } from "../lib/router.ts";
import type { MetricDistribution, MetricGroup, MetricName, Overview } from "../lib/types.ts";
import { said, t } from "../lib/words.ts";
import { auc_text, group_title, histograms } from "../plots/histogram.ts";
import { interval_strip } from "../plots/small.ts";
import { card, select_field } from "../ui/parts.ts";
import { empty_box, load_into } from "../ui/states.ts";
import { data_table, plain_table, type Column } from "../ui/table.ts";

/** Direction and unit of a metric, and how it was counted. */
function about_text({ better, unit }: MetricDistribution): string {
  const direction = better === "lower" ? t("Lower values are better.") : better === "higher" ? t("Higher values are better.") : t("Neither higher nor lower values are better.");
  const name = unit_text(unit);
  return [direction, name && t("Unit: {0}.", name), t("Each person counts once, with the mean of all attempts.")].filter(Boolean).join(" ");
}

function quartile_table(metric: MetricDistribution): HTMLElement {
  const value = (title: string, name: "min" | "q1" | "median" | "q3" | "max"): Column<MetricGroup> => ({ name, title, is_number: true, cell: (one) => with_unit(one[name], metric.unit) });
  const columns: Column<MetricGroup>[] = [
    { name: "group", title: t("Group"), is_header: true, cell: group_title },
    { name: "n", title: t("People"), is_number: true, cell: (one) => String(one.n) },
    { name: "attempts", title: t("Attempts"), is_number: true, cell: (one) => String(one.attempts) },
    value(t("Minimum"), "min"), value(t("Lower quartile"), "q1"), value(t("Median"), "median"), value(t("Upper quartile"), "q3"), value(t("Maximum"), "max"),
  ];
  return data_table({ caption: t("Quartiles of each group"), columns, rows: metric.groups });
}

function show_distribution(metric: MetricDistribution, signal: AbortSignal): Child {
  const unit = unit_text(metric.unit);
  const rank = (one: MetricGroup): number => (one.group === "expert" ? 0 : 2) + (one.simulated ? 1 : 0);
  const filled = metric.groups.filter((one) => one.n > 0).sort((a, b) => rank(a) - rank(b));
  if (filled.length === 0 || metric.edges.length < 2) return empty_box(t("No values"), t("Nobody in this course has a value of this metric at this task yet."));
  const bins = metric.edges.slice(0, -1).map((edge, k) => [t("{0} to {1}", number_text(edge), number_text(metric.edges[k + 1])), ...filled.map((one) => String(one.counts[k] ?? 0))]);
  const shown = { ...metric, groups: filled };
  return card(
    said(metric.title),
    {},
    h("p", { class: "dim" }, about_text(metric)),
    metric.auc
      ? h("p", { class: "auc" }, h("strong", {}, t("Separation of experts and trainees (AUC):"), " "), auc_text(metric.auc), interval_strip(metric.auc.value, metric.auc.low, metric.auc.high), h("span", { class: "dim" }, metric.better === "neither" ? t("Probability that the value of an expert is higher. 0.5: no separation; 0 or 1: complete separation.") : t("Probability that an expert is better than a trainee. 0.5: no separation; 1: complete separation.")))
      : h("p", { class: "notice" }, metric.reason ? sentence(t("Experts and trainees cannot be compared: {0}", said(metric.reason))) : t("Experts and trainees cannot be compared yet: attempts of both groups are needed.")),
    histograms(shown, signal),
    h("details", { class: "as-table" }, h("summary", {}, t("Histogram as a table")), plain_table(t("People in each interval"), [unit ? t("Interval ({0})", unit) : t("Interval"), ...filled.map(group_title)], bins)),
    quartile_table(shown),
  );
}

function show_metrics(overview: Overview, context: PageContext): Child {
  const { query, signal } = context;
  if (overview.tasks.length === 0) return empty_box(t("No tasks"), t("The database has no attempts yet."));
  const chosen = { task: query.get("task") || overview.tasks[0].id, course: query.get("course") ?? "", metric: query.get("metric") ?? "score" };
  const choice_place = h("div", { class: "metric-choice" });
  const place = h("div", { class: "metric-place" });
  const show_metric = (): void => {
    write_query(chosen);
    const path = path_with(`/api/metrics/${encodeURIComponent(chosen.metric)}`, { task: chosen.task, course: chosen.course });
    void load_into(place, signal, () => get<MetricDistribution>(path, signal), (metric) => show_distribution(metric, signal));
  };
  const show_task = (): void => {
    replace_children(place);
    void load_into(choice_place, signal, () => get<{ metrics: MetricName[] }>(path_with("/api/metrics", { task: chosen.task }), signal), ({ metrics }) => {
      if (metrics.length === 0) return empty_box(t("No metrics"), t("Nobody has attempts at this task yet."));
      if (!metrics.some((one) => one.name === chosen.metric)) chosen.metric = metrics[0].name;
      show_metric();
      return select_field(t("Metric"), metrics.map((one) => ({ value: one.name, label: said(one.title) })), chosen.metric, (value) => {
        chosen.metric = value;
        show_metric();
      });
    });
  };
  const courses = [{ value: "", label: t("All courses") }, ...overview.courses.map((one) => ({ value: String(one.id), label: one.name }))];
  const filters = h(
    "div",
    { class: "filters" },
    select_field(t("Task"), overview.tasks.map((one) => ({ value: one.id, label: said(one.title) })), chosen.task, (value) => {
      chosen.task = value;
      show_task();
    }),
    select_field(t("Course"), courses, chosen.course, (value) => {
      chosen.course = value;
      show_metric();
    }),
    choice_place,
  );
  show_task();
  return [filters, place];
}

export async function metrics_page(context: PageContext): Promise<void> {
  context.set_title(t("Metrics"));
  const place = h("div", {});
  context.main.append(h("h1", {}, t("Metrics")), h("p", { class: "lead" }, t("How the values of each metric differ between experts and trainees.")), place);
  await load_into(place, context.signal, () => get<Overview>("/api/overview", context.signal), (overview) => show_metrics(overview, context));
}
