#include "tests/image/oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/povray/emit/scene.h"
#include "compiler/povray/emit/view.h"
#include "compiler/session/stages.h"
#include "runtime/povray/povray.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/scene_files.h"
#include "runtime/system/disk_files.h"
#include "runtime/system/file.h"
#include "runtime/system/temporary_directory.h"
#include "runtime/trace/camera_rays.h"
#include "runtime/trace/traverse/traversal.h"
#include "tests/image/coincidence.h"
#include "tests/unit/povray/cut/cut_graph.h"

namespace graftal {

namespace {

/// What is shown at a place of the picture, in the terms of Shown.
struct Seen {
    bool hit = false;
    double depth = 0;
    Rgb lit{0.0};
};

std::shared_ptr<const PreparedGraph> prepared_of(const DetailedModel& ours) {
    const AnalysedModel& model = *ours.viewed->model;
    return std::make_shared<const PreparedGraph>(
        prepare_graph(model.graph, model.components, model.bounds, ours.detail.preparing()));
}

/// The native engine, asked about single places.
class NativeEye {
  public:
    NativeEye(const DetailedModel& ours, const ShaderLimits& limits)
        : model_(prepared_of(ours), ours.viewed->view, ours.detail), traversal_(model_),
          groundless_(ours.viewed->view), rays_(ours.viewed->view), finder_(groundless_, traversal_),
          shader_(model_.view, traversal_, limits) {
        groundless_.ground.reset();
    }

    Ray ray(double x, double y) const { return rays_.through(x, y); }

    Seen look(double x, double y, bool lit) {
        const Ray ray = rays_.through(x, y);
        const Camera& camera = model_.view.camera;
        Seen seen;
        SurfaceHit hit;
        seen.hit = finder_.first_hit(ray, hit);
        if (seen.hit) seen.depth = glm::dot(ray(hit.t) - camera.location, camera.direction);
        if (lit) seen.lit = shader_.radiance(ray);
        return seen;
    }

  private:
    TraceModel model_;
    Traversal traversal_;
    View groundless_;
    CameraRays rays_;
    Shader finder_, shader_;
};

/// The depths that POV-Ray's picture tells apart.
struct DepthRange {
    double near = 0, far = 1;
    static constexpr double least = 0.05, most = 0.95; ///< of white; black is the background

    double step() const { return (far - near) / (most - least) / 65535; }
};

DepthRange range_of(const Shown& shown) {
    DepthRange range{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = 0; i < shown.hit.size(); ++i) {
        if (!shown.hit[i]) continue;
        range.near = std::min(range.near, shown.depth[i]);
        range.far = std::max(range.far, shown.depth[i]);
    }
    if (!(range.near <= range.far)) return {};
    const double more = std::max(0.02 * (range.far - range.near), 1e-6 * range.far);
    return {range.near - more, range.far + more};
}

Status draw_by_povray(const std::string& directory, ImageSize size, int threads, Image& image) {
    PovrayJob job;
    job.directory = directory;
    job.width = size.width;
    job.height = size.height;
    job.format = PovrayJob::Format::linear16;
    job.threads = threads;
    const PovrayResult result = run_povray(job);
    return result.status.ok() ? read_image(directory + "/" + job.picture, image) : result.status;
}

Status draw_lit(const CompiledModel& model, int threads, Image& image) {
    TemporaryDirectory directory;
    Status status = directory.create();
    TextureStore textures;
    if (status.ok()) status = write_scene(model, directory.path() + "/scene.pov", {}, textures);
    return status.ok() ? draw_by_povray(directory.path(), model.view.size, threads, image) : status;
}

/// A pigment that shows how far along the camera's axis a point lies.
std::string depth_pigment(const Camera& camera, const PovrayUnits& units, const DepthRange& range) {
    const Vec3 at = units(camera.location), along = camera.direction;
    const double share = (DepthRange::most - DepthRange::least) / (range.far - range.near);
    return fmt::format("function {{ min({:.17g}, max({:.17g}, {:.17g} + {:.17g}*(((x-({:.17g}))*({:.17g})"
                       "+(y-({:.17g}))*({:.17g})+(z-({:.17g}))*({:.17g}))/({:.17g})-({:.17g})))) }}"
                       " color_map {{ [0 rgb 0] [1 rgb 1] }}",
                       DepthRange::most + 0.02, DepthRange::least - 0.02, DepthRange::least, share, at.x,
                       along.x, at.y, along.y, at.z, along.z, units.scale, range.near);
}

/// All that is drawn in one texture, that of its depth, on black.
Status draw_depths(CompiledModel model, const DepthRange& range, int threads, Image& image) {
    for (PlacementGroup& group : model.cut.groups) {
        group.material = Material();
        group.palette = 0;
        group.tint = {};
    }
    model.cut.palettes.assign(1, {Rgb(1.0)});
    model.view.sky = {.zenith = Rgb(0.0), .horizon = Rgb(0.0)};
    model.view.ground.reset();
    model.view.lights.clear();
    std::string text;
    std::vector<PaletteImage> palettes;
    const std::string white = "pigment { rgb <1,1,1> } finish { F_default }";
    const std::string depth = "texture { T_depth }";
    emit_povray(
        model.cut, model.view, {.scene_name = "depth"},
        [&](std::string_view piece) { return text += piece, true; }, palettes);
    const PovrayUnits units = choose_units(model.cut, model.view.camera);
    const std::string declared = "#declare T_depth = texture { pigment { " +
                                 depth_pigment(model.view.camera, units, range) +
                                 " } finish { ambient 1 diffuse 0 } }\n";
    const std::string texture = "texture { " + white + " }";
    for (std::size_t at = text.find(texture); at != std::string::npos; at = text.find(texture, at))
        text.replace(at, texture.size(), depth);
    text.insert(text.find("camera {"), declared);
    TemporaryDirectory directory;
    Status status = directory.create();
    if (status.ok()) status = write_text(directory.path() + "/scene.pov", text);
    return status.ok() ? draw_by_povray(directory.path(), model.view.size, threads, image) : status;
}

/// The cut for POV-Ray; and the error that it came to, for both engines.
std::optional<Cut> cut_for_povray(DetailedModel& ours, const OracleOptions& options,
                                  Diagnostics& diagnostics) {
    DetailOptions detail = ours.detail;
    // Where every part is spelt out it shows its own normal, and not the limit's.
    ours.detail.limit_normals = detail.limit_normals = !options.flatten;
    detail.memory_bytes = options.memory_bytes;
    const AnalysedModel& model = *ours.viewed->model;
    Diagnostics found;
    std::optional<Cut> cut = test::cut_graph(model.graph, model.components, model.bounds, ours.viewed->view,
                                             detail, found, {options.flatten});
    for (const Diagnostic& diagnostic : found.all()) {
        const std::string words = "allow an error of ";
        const std::size_t at = diagnostic.message.find(words);
        if (!cut && diagnostic.severity == Severity::error)
            diagnostics.error(diagnostic.span, diagnostic.message);
        if (!cut || at == std::string::npos) continue;
        // The steps of the cut: the digits that are printed are enough to count them.
        constexpr double step = 1.25;
        const double times = std::stod(diagnostic.message.substr(at + words.size())) / cut->error_asked_px;
        const double coarser = std::pow(step, std::round(std::log(times) / std::log(step)));
        if (ours.detail.error_world) ours.detail.error_world = *ours.detail.error_world * coarser;
        ours.detail.error_px *= coarser;
    }
    return cut;
}

/// The same; where the eye is too near for any error in pixels, with one that is everywhere the same length.
std::optional<Cut> any_cut_for_povray(DetailedModel& ours, const OracleOptions& options,
                                      Diagnostics& diagnostics) {
    std::optional<Cut> cut = cut_for_povray(ours, options, diagnostics);
    if (cut || !ours.detail.culls() || ours.detail.error_world) return cut;
    constexpr double finest_share = 1e-4;
    ours.detail.error_world =
        finest_share * ours.viewed->model->bounds[ours.viewed->model->graph.root].ball.radius;
    return cut_for_povray(ours, options, diagnostics);
}

Shown shown_by_povray(const CompiledModel& model, const DepthRange& range, const OracleOptions& options,
                      Status& status) {
    Shown shown;
    Image depths;
    status = draw_depths(model, range, options.threads, depths);
    if (status.ok() && options.lit) status = draw_lit(model, options.threads, shown.lit);
    if (!status.ok()) return shown;
    const auto channels = static_cast<std::size_t>(depths.channels);
    for (std::size_t i = 0; i < depths.pixels.size(); i += channels) {
        const double white = depths.pixels[i];
        const double share = (white - DepthRange::least) / (DepthRange::most - DepthRange::least);
        shown.hit.push_back(white > 0);
        shown.depth.push_back(white > 0 ? range.near + share * (range.far - range.near) : 0);
    }
    return shown;
}

/// Colours by the whole way to the file.
Status draw_natively(const DetailedModel& ours, int threads, Image& image) {
    TemporaryDirectory directory;
    const Status status = directory.create();
    if (!status.ok()) return status;
    RenderOptions options;
    options.output = directory.path() + "/native.png";
    options.format = SampleFormat::linear16;
    options.antialias = std::nullopt;
    options.threads = threads;
    Compilation compilation;
    if (!trace_model({ours.viewed, ours.detail, prepared_of(ours), {}}, options, {}, {}, compilation))
        return compilation.status;
    return read_image(options.output, image);
}

Shown shown_natively(NativeEye& eye, ImageSize size) {
    Shown shown;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const Seen seen = eye.look(x + 0.5, y + 0.5, false);
            shown.hit.push_back(seen.hit);
            shown.depth.push_back(seen.depth);
        }
    return shown;
}

double apart(const Rgb& a, const Rgb& b) {
    double most = 0;
    for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(static_cast<double>(srgb_encoded(static_cast<float>(a[c]))) -
                                       static_cast<double>(srgb_encoded(static_cast<float>(b[c])))));
    return 255 * most;
}

class Comparison {
  public:
    Comparison(OracleReport& report, NativeEye& eye, const Cut& cut, const View& view, double depth_step)
        : report_(report), eye_(eye), coincidence_(cut), camera_(view.camera),
          grounded_(view.ground.has_value()), size_(view.size), depth_step_(depth_step) {}

    void run() {
        report_.pixels = report_.native.hit.size();
        double sum = 0;
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x)
                sum += compare(x, y);
        report_.mean = sum / static_cast<double>(report_.pixels);
    }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
               static_cast<std::size_t>(x);
    }

    Rgb lit(const Shown& shown, std::size_t i) const {
        const auto channels = static_cast<std::size_t>(shown.lit.channels);
        const auto sample = [&](std::size_t c) {
            return shown.lit.pixels[i * channels + std::min(c, channels - 1)];
        };
        return {sample(0), sample(1), sample(2)};
    }

    /// Returns the mean difference of the pixel's colour.
    double compare(int x, int y) {
        const std::size_t i = index(x, y);
        const Shown &povray = report_.povray, &native = report_.native;
        report_.hits += povray.hit[i];
        const bool same = povray.hit[i] == native.hit[i];
        const double steps = 2 * depth_step_, depth = povray.depth[i];
        if (!same)
            note(report_.mask, x, y, [&](const Seen& seen) { return seen.hit == povray.hit[i]; });
        else if (povray.hit[i] && std::abs(depth - native.depth[i]) > steps) {
            // On a steep surface a little to the side is much farther: what lies between is seen too. At a
            // silhouette the surface is as steep as can be.
            double low = native.depth[i], high = low;
            note(report_.depth, x, y, [&](const Seen& seen) {
                low = std::min(low, seen.depth), high = std::max(high, seen.depth);
                return !seen.hit || (low - steps <= depth && depth <= high + steps);
            });
        }
        if (povray.lit.pixels.empty()) return 0;
        const Rgb theirs = lit(povray, i), ours = lit(native, i);
        const double most = apart(theirs, ours);
        const auto agrees = [&](const Seen& seen) { return apart(theirs, seen.lit) <= 1; };
        if (grounded_ && most > 1 && agrees(eye_.look(x + 0.5, y + 0.5, true))) {
            ++report_.horizon;
            return 0;
        }
        report_.max = std::max(report_.max, most);
        if (same && most > 1) note(report_.colour, x, y, agrees);
        double sum = 0;
        for (int c = 0; c < 3; ++c)
            sum += apart(Rgb(theirs[c]), Rgb(ours[c])) / 3;
        return sum;
    }

    template<typename Agrees> void note(Disagreement& disagreement, int x, int y, const Agrees& agrees) {
        constexpr double tie_px = 1e-3;
        ++disagreement.pixels;
        disagreement.away += uniform(report_.povray, x, y) || uniform(report_.native, x, y);
        // Where so much is left there is another reason than ties.
        constexpr std::size_t enough = 1000;
        const bool seek = disagreement.untied - disagreement.coinciding < enough;
        for (int direction = 0; seek && direction < 16; ++direction) {
            const double turn = direction * std::numbers::pi / 8 + 0.1;
            const double reach = direction % 2 ? tie_px : 0.1 * tie_px;
            const bool colours = &disagreement == &report_.colour;
            if (agrees(
                    eye_.look(x + 0.5 + reach * std::cos(turn), y + 0.5 + reach * std::sin(turn), colours)))
                return;
        }
        ++disagreement.untied;
        if (seek && &disagreement == &report_.colour && coincide(x, y))
            ++disagreement.coinciding;
        else if (disagreement.examples.size() < 4)
            disagreement.examples.push_back({x, y});
    }

    bool coincide(int x, int y) const {
        const Ray ray = eye_.ray(x + 0.5, y + 0.5);
        const double depth =
            report_.native.depth[index(x, y)] - glm::dot(ray.origin - camera_.location, camera_.direction);
        return coincidence_.at(ray, depth / glm::dot(ray.direction, camera_.direction));
    }

    /// Whether the pixel and all its neighbours are hit, or none of them.
    bool uniform(const Shown& shown, int x, int y) const {
        for (int v = std::max(0, y - 1); v <= std::min(size_.height - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(size_.width - 1, x + 1); ++u)
                if (shown.hit[index(u, v)] != shown.hit[index(x, y)]) return false;
        return true;
    }

    OracleReport& report_;
    NativeEye& eye_;
    Coincidence coincidence_;
    Camera camera_;
    bool grounded_;
    ImageSize size_;
    double depth_step_;
};

} // namespace

DetailedModel look_at_file(const std::string& path, const StageOptions& options, Compilation& compilation) {
    DetailedModel model{Session(path, disk_files()).viewed(options, compilation), {}};
    if (model.viewed) model.detail = resolved(options.detail, *model.viewed);
    return model;
}

std::optional<OracleReport> ask_oracle(const CompiledModel& theirs, const DetailedModel& ours,
                                       const OracleOptions& options, Status& status) {
    OracleReport report;
    report.error_px = ours.detail.error_world ? 0 : ours.detail.error_px;
    report.error_world = ours.detail.error_world.value_or(0);
    report.placements = theirs.cut.placement_count;
    report.triangles = theirs.cut.triangle_count;
    constexpr double farthest_in_povray = 1e7;
    const PovrayUnits units = choose_units(theirs.cut, theirs.view.camera);
    NativeEye eye(ours, {.farthest = farthest_in_povray / units.scale});
    report.native = shown_natively(eye, ours.viewed->view.size);
    const DepthRange range = range_of(report.native);
    report.povray = shown_by_povray(theirs, range, options, status);
    if (status.ok() && options.lit) status = draw_natively(ours, options.threads, report.native.lit);
    if (!status.ok()) return std::nullopt;
    Comparison(report, eye, theirs.cut, ours.viewed->view, range.step()).run();
    return report;
}

std::optional<OracleReport> ask_oracle(DetailedModel ours, const OracleOptions& options,
                                       Compilation& compilation) {
    std::optional<Cut> cut = any_cut_for_povray(ours, options, compilation.diagnostics);
    if (!cut) return std::nullopt;
    const CompiledModel theirs{ours.viewed->model, ours.viewed->steps, ours.viewed->view, std::move(*cut)};
    return ask_oracle(theirs, ours, options, compilation.status);
}

std::optional<OracleReport> ask_oracle(const std::string& path, const StageOptions& compile,
                                       const OracleOptions& options, Compilation& compilation) {
    DetailedModel ours = look_at_file(path, compile, compilation);
    if (!ours.viewed) return std::nullopt;
    return ask_oracle(std::move(ours), options, compilation);
}

std::string summary(const OracleReport& report) {
    const auto told = [](const char* of, const Disagreement& d) {
        std::string text = fmt::format("; {} {} ({} away, {} untied, {} coinciding)", of, d.pixels, d.away,
                                       d.untied, d.coinciding);
        for (const auto& [x, y] : d.examples)
            text += fmt::format(" at {},{}", x, y);
        return text;
    };
    return fmt::format("{} of {} pixels hit", report.hits, report.pixels) + told("mask", report.mask) +
           told("depth", report.depth) + told("colour", report.colour) +
           fmt::format("; horizon {}; mean {:.4f}, max {:.2f} of 255", report.horizon, report.mean,
                       report.max);
}

} // namespace graftal
