#pragma once
// Materials that the scene file says nothing about keep what the model says, within reason and not in silence.

#include <array>
#include <string>
#include <vector>

#include "io/formats/model.h"

namespace clerestory {

/// 'a', 'b', 'c' and 12 more
class NameList {
 public:
  /// remark  stands behind the name.
  void add(const std::string& name, const std::string& remark = "");
  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }
  const std::string& first() const { return first_; }
  std::string str() const;

 private:
  std::string list_, first_;
  std::size_t count_ = 0;
};

/// Settles materials one by one and gathers what has to be said about them.
class OwnMaterials {
 public:
  /// takes_gloss  else what is glossy in the model is diffuse.
  explicit OwnMaterials(bool takes_gloss) : takes_gloss_(takes_gloss) {}

  /// The model's own description, with reflectances brought below 1.
  Material settle(const ModelMaterial& own);
  /// One line for each kind of assumption.
  std::vector<std::string> warnings() const;
  bool leaves_gloss_out() const { return !matt_.empty(); }
  /// Of which materials, and how much of the light that they reflect it is.
  std::string gloss_left_out() const;

 private:
  void settle_gloss(const ModelGloss& gloss, Material& material);

  bool takes_gloss_;
  NameList undescribed_, white_, textured_, unread_, glass_, glowing_, matt_, too_glossy_;
};

}  // namespace clerestory
