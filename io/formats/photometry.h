#pragma once
// Photometric files of luminaires, by extension: IESNA LM-63 (.ies) and EULUMDAT (.ldt).

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "solver/model/photometric_web.h"

namespace clerestory {

/// warnings  what is odd about the file, each with its name; among them the flux that the file declares when it differs
///           from the integral of its intensities by more than 5 %.
/// named     gets other files that it names, when given.
/// throws    InputError with file, line and reason, also when the extension is unknown.
PhotometricWeb read_photometry(const std::filesystem::path& file, std::vector<std::string>& warnings,
                               std::vector<std::filesystem::path>* named = nullptr);

/// Photometric files, each read once however many entries or fixtures name it.
class PhotometryFiles {
 public:
  /// As read_photometry; `named` gets the file as well.
  std::shared_ptr<const PhotometricWeb> read(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                             std::vector<std::filesystem::path>& named);

 private:
  std::map<std::filesystem::path, std::shared_ptr<const PhotometricWeb>> read_before_;
};

/// Which part of the circle planes C stand for, by the ascending angles that they are at [degrees]: one plane, 0 to 90,
/// 0 to 180, 90 to 270, or from 0 to beyond 180, where 360 may be left out; nothing for others. Source: IESNA LM-63.
std::optional<WebSymmetry> symmetry_of(const std::vector<double>& horizontal);

/// What all formats share: mirrors the planes of web.symmetry all round, so that `horizontal` of type C goes from 0 to
/// 360 degrees, and warns about angles and fluxes that are odd.
/// declared  flux that the intensities should add up to [lm], 0 when the file does not say; at_most: or less.
void complete_web(PhotometricWeb& web, double declared, bool at_most, std::vector<std::string>& warnings);

class NumberWords;

/// Reads the intensities at all angles of `web`, plane by plane, times `scale` [cd]. Negative ones of up to a twentieth
/// of the peak are a meter's offset and become 0, with a warning.
///
/// at      what messages put before the vertical and the horizontal angle.
/// throws  InputError naming the line.
void read_candelas(NumberWords& words, double scale, const std::pair<std::string_view, std::string_view>& at,
                   PhotometricWeb& web, std::vector<std::string>& warnings);

}  // namespace clerestory
