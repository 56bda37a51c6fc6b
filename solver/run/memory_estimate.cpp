#include "solver/run/memory_estimate.h"

#include <algorithm>

#include "solver/hierarchy/links.h"

namespace clerestory {
namespace {

// Fitted to the measured peaks, a little above most of them [MiB]:
//
//   scene                   in       mesh    sides   elements  points   links     measured  predicted
//   cornell_box, draft      20      1,586    1,530      1,884   1,161    62,509       29.5       29.8
//   office, standard       128      5,724    5,824      8,984   5,771   318,042       33.3       37.7
//   house, standard        603      9,286    9,508     18,559  13,481   431,753       41.0       45.5
//   furnace, fine           22      8,194    8,194      8,194   4,553   952,138       39.9       45.2
//   cornell_box, fine       20      8,168    7,936     13,992   7,617   905,289       42.2       46.6
//   house, fine            603     13,682   14,044     46,941  29,857   817,385       52.9       62.3
//   gazebo.obj, fine       730     18,484   15,344     86,684  53,588   635,975       71.8       76.8
//   a campus, standard  31,186     62,234   70,042     83,525  77,997 2,275,932      140.7      137.9
//   a campus, draft     31,186     48,455   58,756     58,510  61,117   495,487      108.9      104.4
//   office, 50 mm          128    489,475  498,422    484,914 248,939 13,154,651     549.3      660
//   house, 100 mm          603    542,961  554,532    538,836 286,042 14,767,515     639.9      733
// (Two threads, one or three channels. The program itself has grown by 5 MiB since.)
//
// Since vertices know what leaves places near them:
//
//   office, standard       128      4,458    4,530     19,554  11,673   483,584       47.6       51.8
//   house, fine            603     10,708   10,934    212,764 119,564 1,251,611      138.3      149.1
//   contacts, fine         144      6,068    5,986    134,540  69,830 1,744,385      101.1      113.8
//
// With layers, whose arrays live side by side only while elements are shown; without, and predicted, in brackets:
//
//   classroom, ten layers, standard                      36,626  21,272 1,348,475       63.7 (56.4)    80 (62)
//   the same, fine                                      111,228  60,820 2,252,804      109.9 (80.0)   151 (96)
//   house, three layers, standard                        75,508  45,061   697,973       81.5 (74.2)    89 (70)
constexpr double kProgram = 35 << 20;
constexpr double kInputTriangle = 430, kTriangle = 400, kSide = 350, kElement = 300, kPoint = 290, kLink = 10;  // [B]
constexpr double kKeptElement = 150, kElementLane = 24, kPointLane = 24;  // with layers [B]

constexpr double kLinksOfRay = 0.6, kMostLinksOfElement = 120;  // above all that was measured
constexpr double kElementsOfPoint = 2;
constexpr double kConforming = 2;  // points for one that is asked for: neighbours are halved as well

double of_element(std::size_t lanes) {
  return kElement + (lanes > 0 ? kKeptElement + kElementLane * static_cast<double>(lanes) : 0);
}
double of_point(std::size_t lanes) { return kPoint + kPointLane * static_cast<double>(lanes); }

double links_of_element(const MemoryPlan& p, double elements) {
  const double rays = p.bundle_rays + p.bright_rays;
  return rays * elements < kLinksToSpare ? rays : std::min(kLinksOfRay * rays, kMostLinksOfElement);
}

}  // namespace

std::size_t predicted_memory(const MemoryCounts& c) {
  const auto n = [](std::size_t count) { return static_cast<double>(count); };
  return static_cast<std::size_t>(kProgram + kInputTriangle * n(c.input_triangles) + kTriangle * n(c.triangles) +
                                  kSide * n(c.sides) + of_element(c.lanes) * n(c.elements) +
                                  of_point(c.lanes) * n(c.points) + kLink * n(c.links));
}

std::optional<MemoryPlan> plan_memory(const MemoryCounts& whole, const MemoryPlan& wish, std::size_t limit) {
  const auto sides = static_cast<double>(whole.sides);
  MemoryPlan plan = wish;
  for (;; plan.bundle_rays /= 2, plan.bright_rays = std::max(kLeastPlan.bright_rays, plan.bright_rays / 2)) {
    const double links = kLink * links_of_element(plan, sides);
    const double room = static_cast<double>(limit) - static_cast<double>(predicted_memory(whole)) - links * sides;
    if (room < 0) {
      if (plan.bundle_rays < 2 * kLeastPlan.bundle_rays) return {};
      continue;
    }
    // What is left is shared by halves for transport and by points that are shown.
    const double more_elements = room / 2 / (kSide + of_element(whole.lanes) + of_point(whole.lanes) + links);
    const double more_points =
        room / 2 / (kConforming * (of_point(whole.lanes) + kElementsOfPoint * of_element(whole.lanes)));
    plan.most_elements = std::min(wish.most_elements, whole.sides + static_cast<std::size_t>(more_elements));
    plan.most_points = std::min(wish.most_points, whole.points + static_cast<std::size_t>(more_points));
    return plan;
  }
}

std::size_t least_memory(const MemoryCounts& whole) {
  const auto sides = static_cast<double>(whole.sides);
  return predicted_memory(whole) + static_cast<std::size_t>(kLink * links_of_element(kLeastPlan, sides) * sides);
}

std::size_t triangles_that_fit(std::size_t input_triangles, std::size_t limit) {
  const double of_triangle =
      kTriangle + 2 * (kSide + kElement + 0.7 * kPoint + kLink * links_of_element(kLeastPlan, 0));
  const double room = static_cast<double>(limit) - static_cast<double>(predicted_memory({input_triangles}));
  return room > 0 ? static_cast<std::size_t>(room / of_triangle) : 0;
}

}  // namespace clerestory
