#pragma once

#include <optional>
#include <string>

#include "compiler/povray/cut/compile.h"
#include "runtime/image/image.h"

namespace graftal {

/// Compiles a model given as text, as render_model_text() takes it. Fails the test, with the diagnostics, if
/// there is no scene.
std::optional<CompiledModel> compile_text(const std::string& name, const std::string& text,
                                          const StageOptions& options, const CutOptions& cut = {});

/// The same for a model file of the project.
std::optional<CompiledModel> compile_file(const std::string& path, const StageOptions& options,
                                          const CutOptions& cut = {});

/// The picture that POV-Ray makes of a compiled model, not antialiased unless asked for (as PovrayJob has
/// it).
Image draw(const CompiledModel& model, SampleFormat format, std::optional<int> antialias = {});

/// The picture of a scene written by hand, which may include what the model was written to as `model.inc`.
Image draw_by_hand(const CompiledModel& model, const std::string& scene, SampleFormat format);

/// The share of the pixels that are unlike the first, where the background is one colour and stands there.
double share_covered(const Image& image);

/// Lets every surface show its pigment, whatever the light: a sample is then the colour itself.
void show_pigments(CompiledModel& model);

/// Culling off, to a depth: what both ways of writing a model draw alike.
StageOptions whole(ImageSize size, std::optional<unsigned> steps = {});

} // namespace graftal
