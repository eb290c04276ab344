#include "apps/view/method_panel.h"

#include <imgui.h>

#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr double kLeastThreshold = 1e-5, kMostThreshold = 0.1;

struct Usual {
  TableSettings table;
  FrameSettings frame;
};

/// What is not given comes to.
Usual usualOf(bool paper) {
  const MethodOptions none{.paper = paper};
  Usual usual{.table = none.table()};
  none.apply(usual.frame);
  return usual;
}

bool drawPaper(MethodOptions& method) {
  bool paper = method.paper;
  if (!ImGui::Checkbox("as in the paper", &paper)) {
    hint("Subr et al. 2007: additive, nearest, no gradient, ...");
    return false;
  }
  method = {.paper = paper, .hierarchyFilter = method.hierarchyFilter, .cullThreshold = method.cullThreshold};
  return true;
}

bool drawTable(MethodOptions& method, const TableSettings& usual) {
  bool changed = choose("directions", kDirectionWords, method.directions, int(usual.directions) - 1);
  hint("Of the table; 98 are more exact, and take more memory and time");
  changed |= choose("code", kCodeWords, method.code, int(usual.code));
  hint("What a byte of the table holds: optical depth, or transmittance");
  changed |= choose("block mean", kHierarchyFilterWords, method.hierarchyFilter, int(usual.filter));
  hint("Which mean of its voxels' transmittances a block has");
  changed |= tick("path length correction", method.pathLengthCorrection, usual.pathLengthCorrection);
  hint("Whether a diagonal step counts its length in full");
  return changed;
}

bool drawDetail(MethodOptions& method, const FrameSettings& usual) {
  bool changed = tick("gradient in a splat", method.gradient, usual.gradient);
  hint("Whether transmittance varies across a splat");
  changed |= slideOptional("level of detail", method.lod, double(usual.lod), 0.0, 8.0, "%.2g px");
  hint("Blocks of voxels up to so many pixels wide are one splat");
  changed |= tick("leave out what is hidden", method.culling, usual.culling);
  hint("Blocks outside of the image or behind others");
  ImGui::BeginDisabled(!method.culling.value_or(usual.culling));
  double threshold = method.cullThreshold.value_or(double(usual.cullThreshold));
  if (slideLogarithmic("hidden below", threshold, kLeastThreshold, kMostThreshold)) {
    method.cullThreshold = threshold;
    changed = true;
  }
  hint("Share of a block's light that reaches the eye");
  ImGui::EndDisabled();
  return changed;
}

}  // namespace

void drawMethodPanel(ViewState& state) {
  if (!ImGui::CollapsingHeader("Method")) return;
  ImGui::PushID("method");
  const LabelRoom room;
  MethodOptions& method = state.method;
  bool changed = drawPaper(method);
  const Usual usual = usualOf(method.paper);
  changed |= choose("composite", kCompositeWords, method.composite, int(usual.frame.composite));
  hint("How splats become a picture; sorted is the classic splatter");
  const bool sorted = method.composite == int(Composite::Sorted);
  ImGui::BeginDisabled(sorted);
  changed |= choose("attenuation", kAttenuationWords, method.attenuation, int(usual.frame.attenuation));
  hint("Transmittance to the eye: from the table, or exact by rays");
  changed |= drawDetail(method, usual.frame);
  ImGui::EndDisabled();
  changed |= drawTable(method, usual.table);
  if (ImGui::Button("Back to the defaults")) {
    method = {};
    changed = true;
  }
  ImGui::PopID();
  state.changed |= changed;
}

void drawBackgroundPanel(ViewState& state) {
  if (!ImGui::CollapsingHeader("Background")) return;
  ImGui::PushID("background");
  const LabelRoom room;
  OutputOptions& output = state.scene.output;
  const std::vector<std::string> words{"dark", "transparent", "colour"};
  int kind = output.transparent ? 1 : output.background ? 2 : 0;
  if (choose("behind", words, kind)) {
    output.transparent = kind == 1;
    output.background.reset();
    if (kind == 2) output.background = glm::dvec3(0.0);
    state.changed = true;
  }
  if (output.background) state.changed |= editColor("colour", *output.background);
  state.changed |= slideOptional("exposure", output.exposure, 0.0, -8.0, 8.0, "%.1f EV");
  state.changed |= choose("tone map", kToneMapWords, output.toneMap, int(ToneMap::None));
  ImGui::PopID();
}

}  // namespace freevoxels
