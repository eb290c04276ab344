#include "engine/volume/blackbody.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace freevoxels {

namespace {

constexpr double kFirstWavelength = 380.0, kWavelengthStep = 10.0;  // nanometres
/// CIE 015:2018, Colorimetry, Table 6 (the 1931 observer, 2 degrees), every 10 nm from 380 to 780.
constexpr std::array<std::array<double, 3>, 41> kObserver{
    {{0.0014, 0.0000, 0.0065}, {0.0042, 0.0001, 0.0201}, {0.0143, 0.0004, 0.0679}, {0.0435, 0.0012, 0.2074},
     {0.1344, 0.0040, 0.6456}, {0.2839, 0.0116, 1.3856}, {0.3483, 0.0230, 1.7471}, {0.3362, 0.0380, 1.7721},
     {0.2908, 0.0600, 1.6692}, {0.1954, 0.0910, 1.2876}, {0.0956, 0.1390, 0.8130}, {0.0320, 0.2080, 0.4652},
     {0.0049, 0.3230, 0.2720}, {0.0093, 0.5030, 0.1582}, {0.0633, 0.7100, 0.0782}, {0.1655, 0.8620, 0.0422},
     {0.2904, 0.9540, 0.0203}, {0.4334, 0.9950, 0.0087}, {0.5945, 0.9950, 0.0039}, {0.7621, 0.9520, 0.0021},
     {0.9163, 0.8700, 0.0017}, {1.0263, 0.7570, 0.0011}, {1.0622, 0.6310, 0.0008}, {1.0026, 0.5030, 0.0003},
     {0.8544, 0.3810, 0.0002}, {0.6424, 0.2650, 0.0000}, {0.4479, 0.1750, 0.0000}, {0.2835, 0.1070, 0.0000},
     {0.1649, 0.0610, 0.0000}, {0.0874, 0.0320, 0.0000}, {0.0468, 0.0170, 0.0000}, {0.0227, 0.0082, 0.0000},
     {0.0114, 0.0041, 0.0000}, {0.0058, 0.0021, 0.0000}, {0.0029, 0.0010, 0.0000}, {0.0014, 0.0005, 0.0000},
     {0.0007, 0.0002, 0.0000}, {0.0003, 0.0001, 0.0000}, {0.0002, 0.0001, 0.0000}, {0.0001, 0.0000, 0.0000},
     {0.0000, 0.0000, 0.0000}}};

/// Planck's law integrated over the observer's curves, in an arbitrary unit.
glm::dvec3 integrate(double kelvin) {
  constexpr double kSecondRadiation = 1.438776877e7;  // h c / k, nanometre kelvin
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < kObserver.size(); ++i) {
    const double wavelength = kFirstWavelength + kWavelengthStep * double(i);
    const double radiance =
        1e15 / (std::pow(wavelength, 5.0) * std::expm1(kSecondRadiation / (wavelength * kelvin)));
    sum += radiance * glm::dvec3(kObserver[i][0], kObserver[i][1], kObserver[i][2]);
  }
  return sum;
}

/// The colour in linear Rec.709 (ITU-R BT.709, white D65), scaled to luminance 1 and clipped to the gamut.
/// The blue that is clipped from a deep red is negligible.
glm::dvec3 chroma(glm::dvec3 xyz) {
  const glm::dmat3 toRec709(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                            0.0415560, 1.0572252);
  const glm::dvec3 color = glm::max(toRec709 * xyz, glm::dvec3(0.0));
  return color / glm::dot(color, glm::dvec3(0.2126729, 0.7151522, 0.0721750));
}

/// A table in equal steps of 1 / temperature, over which the logarithm of the luminance is nearly linear
/// (Wien).
class Table {
 public:
  Table() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const glm::dvec3 xyz = blackbodyXyz(
          1.0 / glm::mix(1.0 / kColdestLight, 1.0 / kHottestLight, double(i) / double(entries_.size() - 1)));
      entries_[i] = glm::dvec4(chroma(xyz), std::log(xyz.y));
    }
  }
  glm::dvec3 at(double kelvin) const {
    const double place = (1.0 / kColdestLight - 1.0 / std::min(kelvin, kHottestLight)) /
                         (1.0 / kColdestLight - 1.0 / kHottestLight) * double(entries_.size() - 1);
    const std::size_t low = std::min(std::size_t(place), entries_.size() - 2);
    const glm::dvec4 entry = glm::mix(entries_[low], entries_[low + 1], place - double(low));
    return glm::dvec3(entry) * std::exp(entry.a);
  }

 private:
  std::array<glm::dvec4, 2048> entries_;
};

}  // namespace

glm::dvec3 blackbodyXyz(double kelvin) {
  static const double reference = integrate(kReferenceTemperature).y;
  return integrate(kelvin) / reference;
}

glm::dvec3 blackbodyColor(double kelvin) {
  static const Table table;
  return kelvin >= kColdestLight ? table.at(kelvin) : glm::dvec3(0.0);
}

}  // namespace freevoxels
