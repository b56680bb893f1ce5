#include "report/detail/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/structure_words.h"

namespace trocar::report::detail {

std::string escape(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      case '\n':
      case '\t':
        out += c;
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return out;
}

std::string number_text(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  if (!text.starts_with('-')) return text;
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero ? text.substr(1) : "\u2212" + text.substr(1);
}

std::string words(std::string_view name) {
  std::string out = anatomy::structure_words(name);
  std::replace(out.begin(), out.end(), '-', ' ');
  return out;
}

std::string title_words(std::string_view name) {
  return capitalised(words(name));
}

std::string joined_words(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + escape(words(name));
  return out;
}

std::string given_name(std::string_view name) {
  return name.empty() ? std::string() : "<span translate=\"no\">" + escape(name) + "</span>";
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t n) {
      return i + n < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + n])) : 0U;
    };
    const unsigned group = byte(0) << 16 | byte(1) << 8 | byte(2);
    out += kDigits[group >> 18];
    out += kDigits[group >> 12 & 63];
    out += i + 1 < bytes.size() ? kDigits[group >> 6 & 63] : '=';
    out += i + 2 < bytes.size() ? kDigits[group & 63] : '=';
  }
  return out;
}

double text_width(std::string_view text, double font_px) {
  constexpr double kMeanAdvance = 0.56;  // of a sans serif font, in its size
  std::size_t letters = 0;
  for (const char c : text) letters += (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;  // UTF-8 continuation bytes
  return kMeanAdvance * font_px * static_cast<double>(letters);
}

namespace {

// Colours of curves are dark enough for 4.5:1 on white; stripes of tissues also differ in lightness.
constexpr std::string_view kPageStyle = R"css(
:root { --ink: #1c2733; --soft: #5a6875; --line: #d9dfe5; --accent: #0b6e75; --paper: #ffffff; }
* { box-sizing: border-box; }
body { margin: 0; background: #eef1f4; color: var(--ink); font: 15px/1.5 "Segoe UI", "Helvetica Neue", "DejaVu Sans",
  Arial, sans-serif; -webkit-print-color-adjust: exact; print-color-adjust: exact; }
main { max-width: 1020px; margin: 0 auto; background: var(--paper); padding: 34px 44px 44px; }
header { border-bottom: 3px solid var(--accent); padding-bottom: 14px; margin-bottom: 22px; }
h1 { font-size: 29px; line-height: 1.2; margin: 0 0 8px; font-weight: 650; letter-spacing: -0.01em; }
h2 { font-size: 18.5px; margin: 34px 0 8px; font-weight: 650; }
p { margin: 6px 0; }
.facts { display: flex; flex-wrap: wrap; gap: 2px 26px; margin: 0; }
.facts div { display: flex; gap: 7px; }
.facts dt { color: var(--soft); } .facts dd { margin: 0; font-weight: 600; }
.note { color: var(--soft); font-size: 13px; }
.harm { background: #b3261e; color: #fff; border-radius: 8px; padding: 10px 16px; margin: 14px 0; font-weight: 700; }
.warning { border-left: 4px solid #b45309; background: #fff6e6; padding: 8px 14px; margin: 14px 0; }
.verdict { display: flex; gap: 20px; align-items: flex-start; border: 2px solid currentColor; border-radius: 10px;
  padding: 16px 20px; margin: 0 0 6px; }
.verdict .icon { flex: 0 0 54px; width: 54px; } .verdict div { color: var(--ink); }
.verdict h2 { font-size: 27px; line-height: 1.1; margin: 2px 0 4px; }
.passed, .passed h2 { color: #146c2e; } .failed, .failed h2 { color: #b3261e; } .unjudged { color: #5a6875; }
.passed { background: #f0f8f2; } .failed { background: #fdf1f0; } .unjudged { background: #f6f8fa; }
.reasons { margin: 8px 0 2px; padding-left: 20px; font-size: 16.5px; font-weight: 600; }
h3 { font-size: 15px; margin: 12px 0 2px; color: var(--soft); font-weight: 600; }
.first-hint { font-size: 17px; border-left: 4px solid var(--accent); background: #eef7f8; padding: 10px 16px; }
.when { color: var(--soft); font-size: 13px; white-space: nowrap; }
table.actions td:nth-child(3), table.actions th:nth-child(3) { text-align: left; width: 75%; }
table.steps td:first-child { width: 62%; } table.steps .undone td { color: var(--soft); }
.result { display: flex; gap: 34px; align-items: center; }
.ring { flex: 0 0 188px; text-align: center; }
.ring svg { width: 172px; display: block; margin: 0 auto; }
.parts { flex: 1; border-collapse: collapse; width: 100%; }
.parts td { padding: 4px 8px 4px 0; vertical-align: middle; }
.parts .bar { width: 38%; } .parts .number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
.track { height: 13px; border: 1px solid #9fb0bb; border-radius: 7px; overflow: hidden; background: #f3f6f8; }
.fill { height: 100%; background: var(--accent); }
.fill.low { background: #b45309; }
ol.hints { margin: 8px 0; padding-left: 24px; } ol.hints li { margin: 5px 0; }
figure { margin: 12px 0 4px; } figcaption { color: var(--soft); font-size: 13px; margin-top: 4px; }
svg { display: block; width: 100%; height: auto; font: 11.5px "Segoe UI", "Helvetica Neue", "DejaVu Sans", Arial,
  sans-serif; fill: var(--ink); }
.pair { display: flex; gap: 18px; } .pair figure { flex: 1; }
.slices { display: flex; gap: 14px; align-items: flex-start; } .slices figure { min-width: 0; }
.slices figcaption { text-align: center; }
table.list { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
table.list th, table.list td { text-align: right; padding: 4px 10px; border-bottom: 1px solid var(--line); }
table.list th { color: var(--soft); font-weight: 600; border-bottom: 1.5px solid #9fb0bb; }
table.list th:first-child, table.list td:first-child { text-align: left; padding-left: 0; }
table.case td, table.case th { text-align: left; overflow-wrap: anywhere; } table.case th { width: 210px; }
details { margin-top: 12px; } summary { cursor: pointer; font-weight: 600; }
pre { font: 12px/1.4 "DejaVu Sans Mono", Consolas, monospace; background: #f6f8fa; padding: 12px; overflow-x: auto;
  white-space: pre-wrap; }
.key { display: flex; flex-wrap: wrap; gap: 4px 20px; font-size: 13px; margin: 6px 0 0; padding: 0; list-style: none; }
.key li { display: flex; align-items: center; gap: 7px; }
.key svg { width: 30px; height: 13px; }
footer { margin-top: 38px; padding-top: 10px; border-top: 1px solid var(--line); color: var(--soft); font-size: 12.5px; }
)css";

constexpr std::string_view kPlotStyle = R"css(
.axis { stroke: #51606d; } .grid { stroke: #dde3e8; stroke-width: 0.8; } .zero { stroke: #7b8a96; stroke-width: 1; }
.frame { fill: none; stroke: #51606d; stroke-width: 1; } .title { font-size: 12.5px; }
.curve { fill: none; stroke-width: 1.5; stroke-linejoin: round; }
.c-total { stroke: #14212b; } .c-second { stroke: #1d5fa8; stroke-dasharray: 7 3; }
.c-third { stroke: #b4430c; stroke-dasharray: 2 2.5; }
.c-pre { stroke: #c2410c; } .c-friction { stroke: #1d5fa8; stroke-dasharray: 7 3; }
.c-cutting { stroke: #0f7b4f; stroke-dasharray: 2 2.5; } .c-stick { stroke: #7b3aa5; stroke-dasharray: 9 3 2 3; }
.c-tip { stroke: #0a6ea8; } .c-body { stroke: #a05a00; stroke-dasharray: 6 2; }
.c-constraint { stroke: #a16207; stroke-dasharray: 10 4; } .c-device { stroke: #0e7490; stroke-dasharray: 3.5 2.5; }
.c-depth, .c-velocity { stroke: #14212b; stroke-width: 1.2; }
.lead { stroke: #51606d; stroke-width: 0.8; }
.mark { fill: #ffffff; stroke: #b91c1c; stroke-width: 2.2; }
.marklabel { font-size: 12.5px; font-weight: 650; stroke: #ffffff; stroke-width: 3.5px; paint-order: stroke; }
.bandname, .eventname { fill: #3d4b57; } .event { stroke: #51606d; stroke-width: 1; stroke-dasharray: 1.5 2.5; }
.band { fill: #eceff2; }
.t-skin { fill: #f2c9a8; } .t-adipose { fill: #fdf4cf; } .t-muscle { fill: #f1cfcf; } .t-liver { fill: #ead9d0; }
.t-liver_lesion { fill: #d3e6b5; } .t-vessel { fill: #cfd8f1; } .t-bone { fill: #e3ddca; } .t-air { fill: #ffffff; }
.t-cartilage { fill: #dbe6e4; } .t-lung { fill: #f5e3ea; } .t-bowel { fill: #f1ddcb; } .t-fluid { fill: #d4ebf5; }
.t-ligament { fill: #dfe8c8; } .t-ligamentum_flavum { fill: #f3e28a; } .t-csf { fill: #cfe9fb; } .t-nerve { fill: #e6d5ec; }
.t-ascites { fill: #d4ebf5; } .t-peritoneum { fill: #eec3d2; } .t-bile_duct { fill: #cfe3b0; } .t-gallbladder { fill: #cfe3b0; }
.t-organ, .t-kidney, .t-spleen { fill: #e6dada; } .t-soft_tissue { fill: #f3ece6; } .t-gas { fill: #ffffff; }
.p-outside { fill: #ffffff; } .p-loading { fill: #f6d9a8; } .p-inserted { fill: #eef2f5; } .p-retracting { fill: #dbe3ea; }
.piece { stroke: #ffffff; stroke-width: 1.5; }
)css";

constexpr std::string_view kPictureStyle = R"css(
.letter { fill: #ffffff; font-weight: 650; text-anchor: middle; stroke: #000000; stroke-width: 3px; paint-order: stroke; }
.planned { fill: none; stroke: #4ade80; stroke-dasharray: 9 6; }
.own { fill: none; stroke: #fb923c; } .shaft { fill: none; stroke: #fb923c; }
.halo { fill: none; stroke: #000000; opacity: 0.55; }
.entry { fill: #4ade80; stroke: #000000; } .own-entry { fill: #fb923c; stroke: #000000; }
.target { fill: none; stroke: #4ade80; } .target-halo { fill: none; stroke: #000000; opacity: 0.7; }
.tip { fill: #fb923c; stroke: #000000; } .scale { stroke: #ffffff; } .scale-halo { stroke: #000000; }

@media screen and (max-width: 800px) {
  main { padding: 18px; } .result, .slices, .pair { flex-direction: column; }
  .result > *, .slices figure { width: 100%; }
}
@page { size: A4; margin: 13mm 12mm; }
@media print {
  body { background: #ffffff; font-size: 11.5px; } main { max-width: none; padding: 0; }
  h1 { font-size: 22px; } h2 { font-size: 14.5px; margin-top: 18px; break-after: avoid; }
  figure, table, .result, .hints, section.together { break-inside: avoid; }
  .note, figcaption, .key, footer { font-size: 10px; } .parts td { padding: 2px 8px 2px 0; }
  .verdict h2 { font-size: 20px; margin-top: 0; } .verdict .icon { flex-basis: 38px; width: 38px; }
  .reasons, .first-hint { font-size: 13px; }
  .ring { flex-basis: 130px; } .ring svg { width: 122px; }
}
)css";

}  // namespace

std::string style_sheet() {
  return std::string(kPageStyle) + std::string(kPlotStyle) + std::string(kPictureStyle);
}

std::string plot_style() {
  // In a page, the page's style covers all <svg> elements.
  constexpr std::string_view kAlone =
      "svg { font: 11.5px \"Segoe UI\", \"Helvetica Neue\", \"DejaVu Sans\", Arial, sans-serif; fill: #1c2733; }\n"
      ".paper { fill: #ffffff; } .heading { font-size: 14px; font-weight: 650; }";
  return std::string(kAlone) + std::string(kPlotStyle);
}

}  // namespace trocar::report::detail
