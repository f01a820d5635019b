#pragma once

#include <string>

#include "compiler/povray/sdl_writer.h"
#include "compiler/scene/light_list.h"
#include "compiler/scene/povray_units.h"
#include "compiler/scene/scene.h"

namespace graftal {

/// Camera, lights (soft ones as a list of that size), sky and ground. The camera carries the mirror between
/// the right-handed scene and POV-Ray's left-handed habit: its axes are given outright, never by look_at.
/// `sky_file`: of the sky's picture, if it is shown.
void write_view(SdlWriter& out, const View& view, const PovrayUnits& units, Vec3 centre,
                const LightListSize& lights, const std::string& ground_texture,
                const std::string& sky_file = {});

} // namespace graftal
