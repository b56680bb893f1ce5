// Evidence that the scores measure skill: separation, consistency, pass mark.

import { get } from "../lib/api.ts";
import { h, type Child } from "../lib/dom.ts";
import { fixed, number_text, sentence, unit_text } from "../lib/format.ts";
import { separation_strength } from "../lib/judgement.ts";
import type { PageContext } from "../lib/router.ts";
import type { Overview, Validity, ValidityMetric } from "../lib/types.ts";
import { decimal, plural, said, t } from "../lib/words.ts";
import { interval_strip } from "../plots/small.ts";
import { evidence_filters } from "../ui/evidence.ts";
import { card, fold_card } from "../ui/parts.ts";
import { empty_box, load_into } from "../ui/states.ts";
import { data_table, type Column } from "../ui/table.ts";

function figure_card(title: string, value: string | null, text: Child, reason: string | null | undefined): HTMLElement {
  return card(
    title,
    { class: "card-figure" },
    value === null ? [h("p", { class: "figure figure-none" }, t("Not computed")), h("p", {}, sentence(reason ? said(reason) : t("there are too few data")))] : [h("p", { class: "figure" }, value), h("p", {}, text)],
  );
}

/** Sentences side by side; empty ones are left out. */
function together(...sentences: string[]): string {
  return sentences.filter(Boolean).join(" ");
}

function interval_text(low: number | null | undefined, high: number | null | undefined): string {
  return low === null || low === undefined || high === null || high === undefined ? "" : t("95 % interval: {0} to {1}.", fixed(low, 2), fixed(high, 2));
}

function p_text(p: number | null): string {
  if (p === null) return "–";
  return p < 0.001 ? decimal("< 0.001") : fixed(p, 3);
}

function metrics_table(metrics: ValidityMetric[]): HTMLElement {
  const columns: Column<ValidityMetric>[] = [
    { name: "title", title: t("Metric"), is_header: true, key: (one) => said(one.title), cell: (one) => [said(one.title), unit_text(one.unit) && h("span", { class: "dim" }, ` (${unit_text(one.unit)})`)] },
    { name: "expert", title: t("Median of experts"), is_number: true, key: (one) => one.expert_median, cell: (one) => [number_text(one.expert_median), one.n_expert !== null && h("span", { class: "dim" }, ` (n\u00a0${one.n_expert})`)] },
    { name: "novice", title: t("Median of novices"), is_number: true, key: (one) => one.novice_median, cell: (one) => [number_text(one.novice_median), one.n_novice !== null && h("span", { class: "dim" }, ` (n\u00a0${one.n_novice})`)] },
    {
      name: "auc", title: t("AUC (95 % interval)"), is_number: true, key: separation_strength,
      cell: (one) =>
        one.auc === null
          ? h("span", { class: "dim" }, said(one.reason ?? "–"))
          : h("span", { class: "compared" }, interval_strip(one.auc, one.low, one.high), h("span", { class: "auc-number" }, fixed(one.auc, 2), h("span", { class: "dim" }, one.low === null ? "" : ` (${fixed(one.low, 2)}–${fixed(one.high, 2)})`))),
    },
    { name: "p", title: metrics.some((one) => one.p_corrected !== undefined) ? t("p (corrected for multiple tests)") : "p", is_number: true, key: (one) => one.p_corrected ?? one.p, cell: (one) => p_text(one.p_corrected ?? one.p) },
    {
      name: "discriminates", title: t("Separates the groups"), key: (one) => (one.discriminates === null ? null : one.discriminates ? 0 : 1),
      cell: (one) => (one.discriminates === null ? "–" : one.discriminates ? h("span", { class: "outcome outcome-good" }, t("✓ Yes")) : h("span", { class: "outcome" }, t("No"))),
    },
  ];
  const has_open_direction = metrics.some((one) => one.better === "neither" && one.auc !== null);
  const table = data_table({ caption: t("Separation of experts and novices by each metric"), columns, rows: metrics, order: { column: "auc", is_descending: true }, page_size: 100 });
  const help = h("p", { class: "help" }, t("AUC of a metric without a better direction: the probability that the value of an expert is higher. Such metrics are sorted by the distance of the AUC from 0.5."));
  return h("div", { class: "stack" }, table, has_open_direction && help);
}

function discriminating_text(found: Validity["discriminating"]): string {
  if (!found) return "";
  const note = found.note ? sentence(said(found.note)) : "";
  const { count, of, uncorrected } = found;
  const counts =
    uncorrected === null || uncorrected === undefined
      ? t("{0} of {1} metrics separate experts from novices.", count ?? 0, of ?? 0)
      : t("{0} of {1} metrics separate experts from novices (without correction for multiple tests: {2}).", count ?? 0, of ?? 0, uncorrected);
  return together(counts, note, t("For comparison: 37 of 60 in a published automatic assessment."));
}

function who_text({ experts, novices, expert_attempts, novice_attempts }: Validity): string {
  return together(
    t("Experts: {0}, novices: {1}.", experts, novices),
    t("The first three attempts of each person count: {0} of experts, {1} of novices.", expert_attempts ?? 0, novice_attempts ?? 0),
  );
}

function show_validity(answer: Validity): Child {
  const { discriminating, alpha, pass_mark, metrics, score, passed } = answer;
  const unscored = (answer.expert_unscored ?? 0) + (answer.novice_unscored ?? 0);
  const share = discriminating?.share ?? null;
  return [
    answer.simulated &&
      h("div", { class: "notice notice-simulated" }, h("p", { class: "notice-title" }, t("Simulated attempts")), h("p", {}, t("Some or all of these attempts come from scripted operators. They only test the calculation; they say nothing about people."))),
    h("p", { class: "lead" }, who_text(answer)),
    unscored > 0 && h("p", { class: "dim" }, plural(unscored, "{0} attempt ended without a result: not passed, and without a score.", "{0} attempts ended without a result: not passed, and without a score.")),
    answer.counts_text ? h("p", { class: "dim" }, t("In total: {0}.", said(answer.counts_text))) : null,
    h(
      "div",
      { class: "figures" },
      figure_card(t("Metrics that separate experts from novices"), share === null ? null : `${fixed(100 * share, 0)} %`, discriminating_text(discriminating), discriminating?.reason ?? answer.reason),
      figure_card(
        t("Internal consistency"),
        alpha === null || alpha.value === null ? null : fixed(alpha.value, 2),
        together(t("Cronbach's alpha. Parts of the score: {0}, people: {1}.", alpha?.items ?? 0, alpha?.n ?? 0), interval_text(alpha?.low, alpha?.high), t("Values from 0.7 are usually called acceptable.")),
        alpha?.reason ?? answer.reason,
      ),
      score && figure_card(t("Separation by the score"), score.auc === null ? null : fixed(score.auc, 2), together(t("AUC of the score."), interval_text(score.low, score.high), t("Median of experts {0}, of novices {1}.", number_text(score.expert_median), number_text(score.novice_median))), score.reason),
      passed && figure_card(t("Separation by passed attempts"), passed.auc === null ? null : fixed(passed.auc, 2), together(t("AUC of the share of passed attempts."), interval_text(passed.low, passed.high), t("Median of experts {0} %, of novices {1} %.", fixed(100 * (passed.expert_median ?? 0), 0), fixed(100 * (passed.novice_median ?? 0), 0))), passed.reason),
      figure_card(
        t("Pass mark"),
        pass_mark === null || pass_mark.value === null ? null : fixed(pass_mark.value, 1),
        together(t("Score at which the groups separate best (contrasting groups method)."), t("Of {1} novices, {0} would pass with it; of {3} experts, {2} would fail.", pass_mark?.false_passes ?? 0, pass_mark?.novices ?? 0, pass_mark?.false_fails ?? 0, pass_mark?.experts ?? 0)),
        pass_mark?.reason ?? answer.reason,
      ),
    ),
    fold_card(t("All metrics"), {}, !metrics || metrics.length === 0 ? empty_box(t("No metrics"), sentence(answer.reason ? said(answer.reason) : t("attempts of experts and of novices are needed"))) : metrics_table(metrics)),
  ];
}

function show_tasks(overview: Overview, context: PageContext): Child {
  return evidence_filters(overview, context, "/api/validity", show_validity);
}

export async function validity_page(context: PageContext): Promise<void> {
  context.set_title(t("Validity"));
  const place = h("div", {});
  context.main.append(h("h1", {}, t("Validity")), h("p", { class: "lead" }, t("Do the scores measure skill? Experts compared with novices.")), place);
  await load_into(place, context.signal, () => get<Overview>("/api/overview", context.signal), (overview) => show_tasks(overview, context));
}
