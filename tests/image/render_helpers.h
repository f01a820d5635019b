#pragma once

#include <string>

#include "runtime/image/image.h"
#include "runtime/render/povray_engine.h"

namespace graftal {

/// Options for pictures that are measured: small, linear, not antialiased.
RenderOptions measured(int width, int height);

/// Renders a model given as text. `name` is the file that it would be in ("gasket.inst"): its extension says
/// the language; `use "scenes/hart/elm.inst"` finds the models of the project. Fails the test,
/// with the diagnostics, if there is no picture. The output of the options is ignored.
Image render_model_text(const std::string& name, const std::string& text, const RenderOptions& options,
                        PovrayReport* report = nullptr);

/// The same for a model file of the project, such as "scenes/hart/pound_sign.rifs".
Image render_model_file(const std::string& path, const RenderOptions& options,
                        PovrayReport* report = nullptr);

} // namespace graftal
