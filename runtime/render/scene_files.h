#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/povray/cut/compile.h"
#include "compiler/scene/light_list.h"
#include "compiler/support/control.h"
#include "compiler/support/status.h"
#include "runtime/image_files/texture_store.h"

namespace graftal {

struct SceneForm {
    bool include = false;                     ///< the `.inc` form
    bool progress = false;                    ///< with the marks that the POV-Ray driver reads
    std::string identifier = {};              ///< PovrayOptions::identifier
    std::optional<LightListSize> lights = {}; ///< PovrayOptions::lights
};

/// Writes the model as SDL to `path`, and the palettes and pictures that it refers to beside it, each whole
/// or not at all. A raised flag ends it early as a failure, "interrupted". `pictures`, if not null, gets the
/// names of the files beside it.
Status write_scene(const CompiledModel& model, const std::string& path, const SceneForm& form,
                   TextureStore& textures, const CancelFlag& cancel = {},
                   std::vector<std::string>* pictures = nullptr);

/// Writes the scene to standard output. Fails if the model needs palette files: there is no place for them.
Status print_scene(const CompiledModel& model, bool include, Diagnostics& diagnostics,
                   const CancelFlag& cancel = {});

/// Fails if no file can be made at `path`: its folder is missing or closed, or it is a folder itself.
Status check_writable(const std::string& path);

} // namespace graftal
