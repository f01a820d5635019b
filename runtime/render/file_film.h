#pragma once

#include "compiler/detail/graph/cut_graph.h"
#include "runtime/render/render.h"
#include "runtime/trace/picture_film.h"

namespace graftal {

/// Develops each pass as the picture's format wants it, and hands it on. Keeps a reference to the options.
class DevelopedFilm : public PictureFilm {
  public:
    explicit DevelopedFilm(const RenderOptions& options) : options_(options) {}

    void begin(const PictureShape& shape) override { shape_ = shape; }
    void tile(const Tile&, const Image&, int) override {}
    Status end(int pass, const Image& picture, const AovPicture* aovs) override;

  protected:
    virtual Status take(const Image& developed, const AovPicture* aovs) = 0;
    const RenderOptions& options() const { return options_; }

  private:
    const RenderOptions& options_;
    PictureShape shape_;
};

/// Writes each pass to the file that is asked for, in place of the one before, with the AOVs as further
/// channels.
class FileFilm final : public DevelopedFilm {
  public:
    FileFilm(const RenderOptions& options, const CutGraph& cut) : DevelopedFilm(options), cut_(cut) {}

  private:
    Status take(const Image& developed, const AovPicture* aovs) override;

    const CutGraph& cut_;
};

/// Keeps the last pass: the samples that the file would have.
class MemoryFilm final : public DevelopedFilm {
  public:
    using DevelopedFilm::DevelopedFilm;
    const Image& picture() const { return picture_; }

  private:
    Status take(const Image& developed, const AovPicture*) override {
        picture_ = developed;
        return {};
    }

    Image picture_;
};

} // namespace graftal
