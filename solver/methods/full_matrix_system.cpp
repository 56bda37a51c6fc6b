#include "solver/methods/full_matrix_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "solver/model/assert.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

/// sum_j F_j x_j in eight sums, which the compiler can keep in vector registers; always the same order.
double dot_product(const float* F, const double* x, std::size_t n) {
  std::array<double, 8> sum{};
  std::size_t j = 0;
  for (; j + 8 <= n; j += 8)
    for (std::size_t lane = 0; lane < 8; ++lane) sum[lane] += double{F[j + lane]} * x[j + lane];
  double rest = 0;
  for (; j < n; ++j) rest += double{F[j]} * x[j];
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7])) + rest;
}

/// One array per channel from a Field.
std::vector<std::vector<double>> by_channel(const Field& field) {
  std::vector<std::vector<double>> arrays(static_cast<std::size_t>(field.channels));
  for (int k = 0; k < field.channels; ++k)
    for (std::size_t i = 0; i < field.size(); ++i) arrays[static_cast<std::size_t>(k)].push_back(field.at(i, k));
  return arrays;
}

}  // namespace

std::string sweep_line(const std::string& method, long sweep, double residual) {
  char line[96];
  std::snprintf(line, sizeof line, "%s: sweep %ld, residual %.2g", method.c_str(), sweep, residual);
  return line;
}

FullMatrixSystem::FullMatrixSystem(const PatchSet& patches, const FormFactorMatrix& F, const Field& E_direct)
    : rho(by_channel(patches.rho)),
      area(patches.area),
      patches_(patches),
      F_(F),
      E_direct_(E_direct),
      n_(patches.patch_count()),
      channels_(patches.channels) {
  CLERESTORY_ASSERT(F.n, ==, n_);
  CLERESTORY_ASSERT(E_direct.size(), ==, n_);
  const auto channel_count = static_cast<std::size_t>(channels_);
  if (!patches.tau.value.empty()) tau = by_channel(patches.tau);
  source = by_channel(patches.M);
  const auto E = by_channel(E_direct);
  for (std::size_t k = 0; k < channel_count; ++k)
    for (std::size_t i = 0; i < n_; ++i) source[k][i] += rho[k][i] * E[k][i] + passed(k, i, E[k]);

  DisjointSets joined(n_);
  for (std::size_t i = 0; i < n_; ++i)
    for (const PatchSet::Behind& other : patches.patches_behind(i)) joined.join(i, other.patch);
  for (std::size_t i = 0; i < n_; ++i) {
    const auto row = F.row(i);
    for (std::size_t j = i + 1; j < n_; ++j)
      if (row[j] > 0) joined.join(i, j);
  }
  std::vector<std::uint32_t> number(n_, 0);
  space_.resize(n_);
  for (std::size_t i = 0; i < n_; ++i) {
    const std::size_t first = joined.find(i);
    if (first == i) number[i] = static_cast<std::uint32_t>(spaces_++);
    space_[i] = number[first];  // the smallest patch of a space comes first
  }

  albedo_ = rho;
  F_albedo_ = lost_ = std::vector(channel_count, std::vector<double>(n_));
  ambient_loss_.assign(channel_count, std::vector<double>(spaces_, 0.0));
  for (std::size_t k = 0; k < channel_count; ++k) {
    for (std::size_t i = 0; i < n_ && !tau.empty(); ++i) albedo_[k][i] += tau[k][i];
    gather_all(albedo_[k], F_albedo_[k]);
    for (std::size_t i = 0; i < n_; ++i) {
      lost_[k][i] = albedo_[k][i] - rho[k][i] * F_albedo_[k][i] - passed(k, i, F_albedo_[k]);
      ambient_loss_[k][space_[i]] += area[i] * lost_[k][i];
    }
  }
  B = source;
  FB = residual = source;
  update_irradiance();
  update_residual();
}

double FullMatrixSystem::gather(std::size_t i, std::span<const double> x, std::size_t begin, std::size_t end) const {
  return F_.row_gain(i) * dot_product(F_.row(i).data() + begin, x.data() + begin, end - begin);
}

void FullMatrixSystem::gather_all(std::span<const double> x, std::span<double> y) const {
  parallel_for(n_, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y[i] = gather(i, x, 0, n_);
  });
}

void FullMatrixSystem::update_irradiance() {
  for (std::size_t k = 0; k < B.size(); ++k) gather_all(B[k], FB[k]);
}

void FullMatrixSystem::update_residual() {
  for (std::size_t k = 0; k < B.size(); ++k)
    for (std::size_t i = 0; i < n_; ++i)
      residual[k][i] = source[k][i] + rho[k][i] * FB[k][i] + passed(k, i, FB[k]) - B[k][i];
}

void FullMatrixSystem::correct_ambient() {
  for (std::size_t k = 0; k < B.size(); ++k) {
    std::vector<double> ambient(spaces_, 0.0);
    for (std::size_t i = 0; i < n_; ++i) ambient[space_[i]] += area[i] * residual[k][i];
    for (std::size_t s = 0; s < spaces_; ++s)
      ambient[s] = ambient_loss_[k][s] > 0 ? ambient[s] / ambient_loss_[k][s] : 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double e = ambient[space_[i]];
      B[k][i] += e * albedo_[k][i];
      FB[k][i] += e * F_albedo_[k][i];
      residual[k][i] -= e * lost_[k][i];
    }
  }
}

double FullMatrixSystem::relative_residual() const {
  double worst = 0;
  for (std::size_t k = 0; k < B.size(); ++k) {
    double left = 0, all = 0;
    for (std::size_t i = 0; i < n_; ++i) left += area[i] * std::abs(residual[k][i]), all += area[i] * source[k][i];
    if (all > 0) worst = std::max(worst, left / all);
  }
  return worst;
}

Losses FullMatrixSystem::losses_of(std::size_t i) const {
  // What a half-filled row does not place has not escaped: it is left over as imbalance.
  if (!F_.row_filled[i]) return {};
  // Below 0 where an open row sums to more than 1: the light it makes.
  const double unplaced = 1 - F_.row_sum[i] * F_.row_gain(i);
  const double escapes = F_.has_gloss ? F_.escapes[i] : unplaced * F_.escapes[i];
  return {Spectrum(escapes), Spectrum(unplaced - escapes)};
}

Solution FullMatrixSystem::finish(std::string method) const {
  Solution solution;
  solution.method = std::move(method);
  solution.E = Field(n_, channels_);
  solution.B = Field(n_, channels_);
  for (std::size_t i = 0; i < n_; ++i)
    for (int k = 0; k < channels_; ++k) solution.E.at(i, k) = E_direct_.at(i, k) + FB[static_cast<std::size_t>(k)][i];
  for (std::size_t i = 0; i < n_; ++i) {
    const Spectrum B_i = patches_.M[i] + patches_.scattered(solution.E, i);
    solution.B.set(i, B_i);
    solution.energy += where_light_ends(patches_, i, solution.E[i], B_i, losses_of(i));
  }
  solution.energy.emitted = total_flux(patches_, patches_.M) + total_flux(patches_, E_direct_);
  CLERESTORY_ASSERT(all_finite(solution.B), ==, true);
  solution.rays = F_.rays;
  return solution;
}

}  // namespace clerestory
