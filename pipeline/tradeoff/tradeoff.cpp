#include "pipeline/tradeoff/tradeoff.h"

#include <cmath>

#include "io/text.h"
#include "pipeline/wording.h"

namespace clerestory {

namespace {

/// What the rms is for sure.
double at_most(const Tradeoff::Error& e) { return e.bound ? e.rms : e.rms + e.confidence; }

}  // namespace

void choose(Tradeoff& t) {
  for (Tradeoff::Row& row : t.rows) {
    row.at_front = true;
    for (const Tradeoff::Row& other : t.rows) {
      const bool is_as_good = other.wall_s <= row.wall_s && other.worst.rms <= row.worst.rms;
      const bool is_better = other.wall_s < row.wall_s || other.worst.rms < row.worst.rms;
      if (is_as_good && is_better) row.at_front = false;
    }
  }
  t.choices.clear();
  for (const double target : kTradeoffTargets) {
    Tradeoff::Choice choice{target, {}};
    for (std::size_t i = 0; i < t.rows.size(); ++i)
      if (at_most(t.rows[i].worst) <= target && (!choice.row || t.rows[i].wall_s < t.rows[*choice.row].wall_s))
        choice.row = i;
    t.choices.push_back(choice);
  }
}

std::string name_of(const Tradeoff::Row& row) { return "--method " + row.method + " " + row.settings; }

std::string share_text(double share, bool bound) {
  if (std::isnan(share)) return "not said";
  return (bound ? "below " : "") + rounded(100 * share, 2) + " %";
}

std::vector<std::string> choices_as_text(const Tradeoff& t) {
  std::vector<std::string> lines;
  for (const Tradeoff::Choice& choice : t.choices) {
    const std::string target = rounded(100 * choice.target, 1) + " %";
    if (!choice.row) {
      lines.push_back(target + ": none of these keeps it");
      continue;
    }
    const Tradeoff::Row& row = t.rows[*choice.row];
    lines.push_back(target + ": " + name_of(row) + ", " + duration(row.wall_s) + ", " + bytes(row.peak_bytes) +
                    ", rms " + share_text(row.worst.rms, row.worst.bound) + ", p95 " + share_text(row.worst.p95));
  }
  return lines;
}

std::string reference_as_text(const Tradeoff& t) {
  const Tradeoff::Reference& r = t.reference;
  std::string line = "reference: " + grouped(static_cast<unsigned long long>(r.paths)) + " paths " +
                     (r.has_gathers ? "and two gathers " : "") + "from each of " + counted(r.points, "point") + ", " +
                     duration(r.seconds) + ", its own standard error at a point " + share_text(r.std_error) +
                     " of the room's mean";
  for (std::size_t k = 0; k < r.not_told.size(); ++k)
    line += (k == 0 ? "; it finds too little light to judge '" : ", '") + quotable(r.not_told[k], 40) + "'";
  return line;
}

std::string tradeoff_csv(const Tradeoff& t) {
  std::string csv =
      "method,settings,wall_s,cpu_s,peak_bytes,elements,links,rays,rms,median,p95,p99,bias,said_rms,said_p95,"
      "confidence,bound,rms_all,median_all,p95_all,p99_all,bias_all,space\n";
  for (const Tradeoff::Row& r : t.rows) {
    std::string space;
    for (const char c : clean_text(r.space)) space += c == '"' ? "\"\"" : std::string(1, c);
    csv +=
        text(r.method, ',', r.settings, ',', r.wall_s, ',', r.cpu_s, ',', r.peak_bytes, ',', r.elements, ',', r.links,
             ',', r.rays, ',', r.worst.rms, ',', r.worst.median, ',', r.worst.p95, ',', r.worst.p99, ',', r.worst.bias,
             ',', r.said_rms, ',', r.said_p95, ',', r.worst.confidence, ',', r.worst.bound ? 1 : 0, ',', r.all.rms, ',',
             r.all.median, ',', r.all.p95, ',', r.all.p99, ',', r.all.bias, ",\"", space, "\"\n");
  }
  return csv;
}

}  // namespace clerestory
