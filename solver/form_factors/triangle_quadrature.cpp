#include "solver/form_factors/triangle_quadrature.h"

#include "solver/sampling/gauss_legendre.h"

namespace clerestory {
namespace {

/// Fills a rule orbit by orbit: all permutations of the barycentric coordinates that differ.
template <std::size_t Points>
class RuleBuilder {
 public:
  RuleBuilder& add(double a, double b, double c, double weight) {
    const std::array<std::array<double, 3>, 6> permutations{
        {{a, b, c}, {b, c, a}, {c, a, b}, {a, c, b}, {c, b, a}, {b, a, c}}};
    const std::size_t count = b == c ? 3 : 6;
    for (std::size_t k = 0; k < count; ++k) add_point(permutations[k][0], permutations[k][1], weight);
    return *this;
  }
  void add_point(double b0, double b1, double weight) {
    rule_.b0[size_] = b0, rule_.b1[size_] = b1, rule_.b2[size_] = 1 - b0 - b1;
    rule_.weight[size_++] = weight;
  }
  const TriangleRule<Points>& rule() const { return rule_; }

 private:
  TriangleRule<Points> rule_;
  std::size_t size_ = 0;
};

TriangleRule<36> collapsed_product() {
  const GaussLegendre<6> line;
  RuleBuilder<36> builder;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) {
      const double u = 0.5 * (1 + line.node[i]), v = 0.5 * (1 + line.node[j]);
      builder.add_point(u, (1 - u) * v, 0.5 * line.weight[i] * line.weight[j] * (1 - u));
    }
  return builder.rule();
}

}  // namespace

const TriangleRule<3>& triangle_rule_3() {
  static const auto rule = RuleBuilder<3>().add(2.0 / 3, 1.0 / 6, 1.0 / 6, 1.0 / 3).rule();
  return rule;
}

const TriangleRule<6>& triangle_rule_6() {
  static const auto rule = RuleBuilder<6>()
                               .add(0.108103018168070, 0.445948490915965, 0.445948490915965, 0.223381589678011)
                               .add(0.816847572980459, 0.091576213509771, 0.091576213509771, 0.109951743655322)
                               .rule();
  return rule;
}

const TriangleRule<12>& triangle_rule_12() {
  static const auto rule = RuleBuilder<12>()
                               .add(0.501426509658179, 0.249286745170910, 0.249286745170910, 0.116786275726379)
                               .add(0.873821971016996, 0.063089014491502, 0.063089014491502, 0.050844906370207)
                               .add(0.053145049844817, 0.310352451033784, 0.636502499121399, 0.082851075618374)
                               .rule();
  return rule;
}

const TriangleRule<36>& triangle_rule_36() {
  static const TriangleRule<36> rule = collapsed_product();
  return rule;
}

}  // namespace clerestory
