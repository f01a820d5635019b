#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "runtime/image_files/image_files.h"
#include "runtime/points/ply_file.h"
#include "runtime/points/point_source.h"
#include "runtime/points/tone.h"
#include "runtime/render/picture_session.h"
#include "runtime/system/file.h"

namespace graftal {

/// A cloud of points in a file instead of a picture of it: `.ply`.
bool is_cloud_name(const std::string& path);

struct PointsOptions {
    StageOptions compile;
    std::string output; ///< is_picture_name() or is_cloud_name()
    /// In place of an output: gets the points of the cloud in order, some at a time, from any thread.
    std::function<void(std::span<const CloudPoint>)> take;
    SampleFormat format = SampleFormat::srgb8; ///< of a PNG
    ImageMetadata metadata;
    std::optional<std::uint64_t> points; ///< nothing: 100 a pixel, or a million of a cloud
    std::string card;                    ///< `.inst` file of a card with the picture (card.h); empty: none
    PointColour colour = PointColour::tint;
    Tone tone;
    int threads = 0;                   ///< 0: all processors
    bool gpu = false;                  ///< a picture's points are made by a graphics card, if it can
    std::optional<std::size_t> device; ///< a number of gpu_devices(); null: the first card
    std::function<void(double fraction)> on_progress;
};

struct PointsReport {
    std::uint64_t points = 0;
    std::uint64_t inside = 0; ///< of the picture
    std::uint32_t maps = 0;
    double seconds = 0;  ///< of making points
    std::string device;  ///< name of the one that made them; empty: the processors
    std::string not_gpu; ///< why these did, though PointsOptions::gpu was asked for
};

/// Number of points that draw_points() will take.
std::uint64_t point_count(const PointsOptions& options);

/// Draws points of a source, or writes them: what draw_points() ends with. `card`: written, and to appear
/// with the picture; null: none. A raised flag ends it: "interrupted".
Status place_points(const PointSource& source, const View& view, const PointsOptions& options,
                    PendingFile* card, const CancelFlag& cancel, PointsReport& report);

/// Model -> points, by random iteration on its graph (chaos/chaos_game.h) or by the formulas of an
/// orbit. The file depends on model, options and seed, not on the number of threads. Nothing comes back, and
/// no file, after errors in `compilation.diagnostics`, or with a failed `compilation.status`. Memory: that of
/// the picture for each thread, or, where that is more than a gigabyte, once.
std::optional<PointsReport> draw_points(PictureSession& session, const PointsOptions& options,
                                        Compilation& compilation);

} // namespace graftal
