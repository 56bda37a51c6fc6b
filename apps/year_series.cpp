#include "apps/year_series.h"

#include <algorithm>

#include "pipeline/wording.h"
#include "solver/evaluate/annual_figures.h"

namespace clerestory {

YearSeriesFiles::YearSeriesFiles(const std::string& hours_place, const std::string& honeybee_place, const Scene& scene,
                                 const DaylightYear& year, Console& console)
    : sensors_(all_sensor_points(scene.sensors)) {
  std::vector<int> hours;
  for (const DaylightHour& h : year.hours) hours.push_back(h.hour);
  if (!hours_place.empty()) {
    console.step("hours of the sensors: " + bytes(bytes_of_series(hours.size(), sensors_.size())) + " into " +
                 hours_place);
    hours_ = make_hour_series(hours_place, hours, sensors_);
  }
  if (!honeybee_place.empty()) {
    std::vector<HoneybeeGrid> grids;
    for (const SensorSet& set : scene.sensors) {
      grids.push_back({set.name, set.points.size()});
      ends_.push_back((ends_.empty() ? 0 : ends_.back()) + set.points.size());
    }
    honeybee_.emplace(honeybee_place, hours, std::move(grids));
  }
}

void YearSeriesFiles::take(const SensorSeries& s) {
  if (hours_) hours_->add(s.total, s.direct);
  const std::size_t H = s.total.size() / std::max<std::size_t>(s.end - s.begin, 1);
  for (std::size_t begin = s.begin, end; begin < s.end && honeybee_; begin = end) {
    const auto grid = static_cast<std::size_t>(std::ranges::upper_bound(ends_, begin) - ends_.begin());
    end = std::min(s.end, ends_[grid]);
    honeybee_->add(grid, s.total.subspan((begin - s.begin) * H, (end - begin) * H),
                   s.direct.subspan((begin - s.begin) * H, (end - begin) * H));
  }
}

void YearSeriesFiles::commit(const Scene& scene, const YearSolved& solved) {
  if (hours_) hours_->commit();
  if (!honeybee_) return;
  std::vector<HoneybeeMetrics> metrics;
  const std::vector<YearFigure> figures = year_figures(solved.rules);
  std::size_t next = 0;
  for (const SensorSet& set : scene.sensors) {
    HoneybeeMetrics& m = metrics.emplace_back();
    for (std::size_t k = 0; k < set.points.size(); ++k, ++next) {
      std::vector<double>* const to[] = {&m.da, &m.cda, &m.udi_lower, &m.udi, &m.udi_upper};
      for (std::size_t f = 0; f < std::size(to); ++f)
        to[f]->push_back(figures[f](solved.of_sensors[next], solved.rules));
    }
  }
  honeybee_->commit(metrics);
}

}  // namespace clerestory
