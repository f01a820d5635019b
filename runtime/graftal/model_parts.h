#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/graftal/messages.h"
#include "runtime/graftal/model.h"
#include "runtime/plants/plant_of_model.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/render.h"
#include "runtime/system/disk_files.h"

namespace graftal::v1 {

/// The session of a model, and what its caller has set.
struct Model::Parts {
    explicit Parts(std::string name) : path(std::move(name)), session(path, Keep::everything, files) {
        session.set_control(
            {CancelFlag([this] { return cancelled.load(); }), [this](const Progress& progress) {
                 const auto done = static_cast<double>(progress.done);
                 const auto total = static_cast<double>(progress.total);
                 tell(progress.stage, total > 0 ? std::optional(done / total) : std::nullopt);
             }});
    }

    void tell(std::string_view stage, std::optional<double> share) const {
        const std::lock_guard one_at_a_time(telling);
        if (listener) listener(stage, share ? std::optional(std::clamp(*share, 0.0, 1.0)) : std::nullopt);
    }

    /// For an engine, which tells the listener.
    RenderOptions told() const {
        RenderOptions render = options;
        render.on_progress = [this](const DrawProgress& progress) { tell("draw", progress.fraction); };
        return render;
    }

    /// The light on plants, within the work that is set, or as much as commands take.
    PlantLightOptions light_options(int samples = MeasureSettings().samples) const {
        PlantLightOptions light;
        if (samples > 0) light.samples = samples;
        light.work_seconds = options.work_seconds.value_or(light.work_seconds);
        return light;
    }

    bool draw(PictureFilm& film, RenderOptions render, Compilation& compilation) {
        render.film = &film;
        return render_natively(session, render, compilation).has_value();
    }

    /// Calls a function that gives a value or nothing.
    template<typename Value, typename Work> Result<Value> run(const Work& work) {
        cancelled = false;
        Compilation compilation;
        std::optional<Value> value = work(compilation);
        if (cancelled) return {std::nullopt, {}, true};
        return {std::move(value), messages_of(compilation), false};
    }

    MemoryFiles files{&disk_files()}; ///< texts of the caller, over those of the disk
    std::string path;                 ///< of the model
    PictureSession session;
    RenderOptions options;
    bool error_asked = false;
    OnProgress listener;
    mutable std::mutex telling;
    std::atomic<bool> cancelled = false;
};

} // namespace graftal::v1
