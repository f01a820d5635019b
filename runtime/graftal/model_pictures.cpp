#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "compiler/povray/cut/compile.h"
#include "compiler/support/number_range.h"
#include "runtime/export/export_model.h"
#include "runtime/export/plant_files.h"
#include "runtime/graftal/model_parts.h"
#include "runtime/image_files/image_files.h"
#include "runtime/render/aov_channels.h"
#include "runtime/render/file_film.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"

namespace graftal::v1 {

namespace {

Picture picture_of(const Image& image) {
    Picture picture{image.width, image.height, {}};
    picture.rgb.reserve(image.pixels.size());
    for (const float sample : image.pixels)
        picture.rgb.push_back(level8_of(sample));
    return picture;
}

/// Hands the tiles on.
class TileFilm final : public PictureFilm {
  public:
    explicit TileFilm(const OnTile& listener) : listener_(listener) {}
    void begin(const PictureShape& shape) override { window_ = shape.window; }
    void tile(const graftal::Tile& tile, const Image& picture, int pass) override {
        const auto row_floats = 3 * static_cast<std::size_t>(picture.width);
        const std::size_t first = row_floats * static_cast<std::size_t>(tile.y - window_.y) +
                                  3 * static_cast<std::size_t>(tile.x - window_.x);
        listener_({tile.x, tile.y, tile.width, tile.height, &picture.pixels[first], row_floats, pass});
    }
    Status end(int, const Image&, const AovPicture*) override { return {}; }

  private:
    const OnTile& listener_;
    graftal::Tile window_;
};

/// Keeps the light and the AOVs of the last pass.
class ChannelFilm final : public PictureFilm {
  public:
    void begin(const PictureShape& shape) override { shape_.emplace(shape); }
    void tile(const graftal::Tile&, const Image&, int) override {}
    Status end(int, const Image& picture, const AovPicture* aovs) override {
        const MoreChannels more = aov_channels(*aovs, shape_->cut, shape_->view);
        channels_ = {picture.width, picture.height, {"R", "G", "B"}, {}, ObjectNumbers(shape_->cut).names()};
        channels_.names.insert(channels_.names.end(), more.names.begin(), more.names.end());
        channels_.samples.reserve(aovs->pixels.size() * channels_.names.size());
        auto light = picture.pixels.begin();
        for (auto others = more.samples.begin(); others != more.samples.end(); light += 3) {
            const auto end = others + static_cast<std::ptrdiff_t>(more.names.size());
            channels_.samples.insert(channels_.samples.end(), light, light + 3);
            channels_.samples.insert(channels_.samples.end(), others, end);
            others = end;
        }
        return {};
    }
    Channels& channels() { return channels_; }

  private:
    std::optional<PictureShape> shape_; ///< since begin()
    Channels channels_;
};

} // namespace

Result<Picture> Model::render() {
    return parts_->run<Picture>([this](Compilation& compilation) -> std::optional<Picture> {
        const RenderOptions options = parts_->told();
        MemoryFilm film(options);
        if (!parts_->draw(film, options, compilation)) return std::nullopt;
        return picture_of(film.picture());
    });
}

Result<Channels> Model::aovs() {
    return parts_->run<Channels>([this](Compilation& compilation) -> std::optional<Channels> {
        RenderOptions options = parts_->told();
        options.aovs = true;
        options.output = "memory.exr"; // is never written
        ChannelFilm film;
        if (!parts_->draw(film, options, compilation)) return std::nullopt;
        return std::move(film.channels());
    });
}

Result<Drawn> Model::draw(const OnTile& listener) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        const Stopwatch watch;
        TileFilm film(listener);
        RenderOptions options = parts_->told();
        options.progressive = true;
        if (!parts_->draw(film, options, compilation)) return std::nullopt;
        return Drawn{{}, watch.seconds()};
    });
}

Result<Drawn> Model::render_to(const std::string& path, Engine engine) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        if (!is_picture_name(path)) {
            compilation.status = Status::failure("'" + path + "' ends neither in .png nor in .exr");
            return std::nullopt;
        }
        const Stopwatch watch;
        RenderOptions render = parts_->told();
        render.output = path;
        const graftal::Engine* const drawing = find_engine(engine == Engine::povray ? "povray" : "native");
        if (!drawing->draw(parts_->session, render, compilation)) return std::nullopt;
        return Drawn{path, watch.seconds()};
    });
}

Result<Drawn> Model::compile_to(const std::string& path) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        const bool include = path.ends_with(".inc");
        if (!include && !path.ends_with(".pov")) {
            compilation.status = Status::failure("'" + path + "' ends neither in .pov nor in .inc");
            return std::nullopt;
        }
        const Stopwatch watch;
        const auto model = compile_scene(parts_->session, parts_->options.compile, compilation);
        if (!model) return std::nullopt;
        compilation.status = write_scene(*model, path, {.include = include}, parts_->session.textures(),
                                         parts_->session.control().cancel);
        if (!compilation.status.ok()) return std::nullopt;
        return Drawn{path, watch.seconds()};
    });
}

Result<Drawn> Model::export_to(const std::string& path, const ExportSettings& settings) {
    return parts_->run<Drawn>([&](Compilation& compilation) -> std::optional<Drawn> {
        const auto fail = [&](std::string why) {
            compilation.status = Status::failure(std::move(why));
            return std::nullopt;
        };
        const ExportFormat* const format = find_export_format(path);
        const PlantFormat* const plant = find_plant_format(path);
        if (!format && !plant)
            return fail(fmt::format("'{}' does not end in {}; {}", path, export_endings(), plant_endings()));
        const StageOptions& stages = parts_->options.compile;
        const ExportModelOptions options{stages,
                                         parts_->error_asked,
                                         {.output = path,
                                          .most_bytes = settings.most_bytes,
                                          .fitted_bytes = settings.most_bytes == ExportSettings().most_bytes
                                                              ? ExportOptions().fitted_bytes
                                                              : settings.most_bytes,
                                          .unit_mm = settings.unit_mm,
                                          .levels = settings.levels,
                                          .instancing = settings.instancing,
                                          .plotter = settings.plotter,
                                          .parts = settings.parts,
                                          .memory_bytes = stages.detail.memory_bytes,
                                          .nodes = settings.nodes,
                                          .metadata = {}}};
        const Stopwatch watch;
        if (!format) {
            std::string problem = refusal_of_plant_options(*plant, options.file, false);
            if (!problem.empty()) return fail(std::move(problem));
            const PlantLightOptions light = parts_->light_options();
            if (!export_plant(parts_->session, parts_->options, *plant, options.file,
                              settings.irradiance ? &light : nullptr, compilation))
                return std::nullopt;
            return Drawn{path, watch.seconds()};
        }
        if (settings.irradiance)
            return fail(fmt::format("irradiance is for {}, not for {}", plant_endings(), format->extension));
        if (const ExportWish* const wish = find_vain_wish(*format, options.file))
            return fail(fmt::format("{} is for {}, not for {}", wish->option, endings_with(wish->has),
                                    format->extension));
        if (settings.unit_mm && !(*settings.unit_mm > 0 && is_size(*settings.unit_mm)))
            return fail("unit is not a positive number of millimetres");
        if (settings.levels && *settings.levels < 2) return fail("levels is less than 2");
        if (settings.nodes && *settings.nodes < 1) return fail("nodes is less than 1");
        if (!export_model(parts_->session, options, compilation)) return std::nullopt;
        return Drawn{path, watch.seconds()};
    });
}

} // namespace graftal::v1
