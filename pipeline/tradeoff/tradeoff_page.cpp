#include <string>

#include "io/text.h"
#include "pipeline/tradeoff/tradeoff.h"
#include "pipeline/tradeoff/tradeoff_chart.h"
#include "pipeline/wording.h"

namespace clerestory {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
body { font: 15px/1.5 sans-serif; color: #1e1e1e; max-width: 64em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; font-size: 13px; }
th, td { padding: .25em .7em; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th:first-child, td:first-child, th:nth-child(2), td:nth-child(2), td.words { text-align: left; }
tr.front td { font-weight: bold; }
.wide { overflow-x: auto; }
svg { max-width: 100%; height: auto; }
code { background: #f2f2f2; padding: .1em .3em; }
</style>
)";

std::string cell(const std::string& words) { return "<td>" + xml_text(words) + "</td>"; }

std::string row_of(const Tradeoff::Row& r) {
  const auto share = [](double value) { return cell(share_text(value)); };
  return text(r.at_front ? "<tr class=\"front\">" : "<tr>", cell(r.method), cell(r.settings), cell(duration(r.wall_s)),
              cell(duration(r.cpu_s)), cell(bytes(r.peak_bytes)), cell(grouped(r.elements)), cell(grouped(r.links)),
              cell(rounded(static_cast<double>(r.rays) * 1e-6) + " M"), cell(share_text(r.worst.rms, r.worst.bound)),
              cell((r.worst.bound ? "" : "+- " + share_text(r.worst.confidence))), share(r.worst.median),
              share(r.worst.p95), share(r.worst.p99), share(r.worst.bias), cell(share_text(r.said_rms, r.said_bound)),
              share(r.said_p95), cell(share_text(r.all.rms, r.all.bound)), share(r.all.p95), share(r.all.bias),
              "<td class=\"words\">", xml_text(r.space), "</td></tr>\n");
}

}  // namespace

std::string tradeoff_page(const Tradeoff& t) {
  std::string page =
      text(kHead, "<title>Time against error: ", xml_text(t.input), "</title>\n</head>\n<body>\n<h1>",
           xml_text(t.input), "</h1>\n<h2>What to choose</h2>\n<p>The fastest run whose rms error in the ",
           "worst room, its confidence included, keeps a target:</p>\n<ul>\n");
  for (const std::string& line : choices_as_text(t)) page += "<li>" + xml_text(line) + "</li>\n";
  page += "</ul>\n<h2>Time against error</h2>\n" + svg_of(tradeoff_chart(t));
  page +=
      "<p>A point a run; its letter is the first of its accuracy. Nothing is faster <em>and</em> nearer to the "
      "reference "
      "than runs on the wide grey line (bold below). A ring is an upper bound: the error is smaller than what the "
      "reference tells.</p>\n<h2>All runs</h2>\n<div class=\"wide\"><table>\n<tr>";
  for (const char* title :
       {"method",    "settings",  "wall", "CPU", "memory", "elements", "links",    "rays",           "rms",
        "",          "median",    "p95",  "p99", "bias",   "said rms", "said p95", "rms, all rooms", "p95, all",
        "bias, all", "worst room"})
    page += text("<th>", title, "</th>");
  page += "</tr>\n";
  for (const Tradeoff::Row& row : t.rows) page += row_of(row);
  page += "</table></div>\n";
  page +=
      "<p>Each run is <code>clerestory solve</code> of its own. rms and bias are relative to the reference's mean, "
      "median, p95 and p99 to each point's own value (to 5 % of the mean where it is darker); all of the worst room, "
      "of "
      "all rooms where it says so. What the run says itself is of the room that it found worst.</p>\n";
  page += "<p>" + xml_text(reference_as_text(t)) + ".</p>\n";
  if (!t.left_out.empty()) {
    page += "<h2>Left out</h2>\n<ul>\n";
    for (const Tradeoff::LeftOut& l : t.left_out)
      page += "<li>" + xml_text(l.method + " " + l.settings + ": " + l.why) + "</li>\n";
    page += "</ul>\n";
  }
  return page + "<p>Clerestory " + xml_text(t.version) + "</p>\n</body>\n</html>\n";
}

}  // namespace clerestory
