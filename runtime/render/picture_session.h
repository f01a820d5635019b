#pragma once

#include "compiler/import/importers.h"
#include "compiler/session/session.h"
#include "runtime/image_files/texture_store.h"
#include "runtime/system/disk_files.h"

namespace graftal {

/// A session for pictures: it reads models of other programs, and the textures that a model names.
class PictureSession : public Session {
  public:
    /// `files` outlive it; textures are read from the disk in any case.
    explicit PictureSession(std::string path, Keep keep = Keep::everything, const Files& files = disk_files())
        : Session(std::move(path), files, keep) {
        translate_with(importing_translator());
        look_at_textures(
            [this](const std::string& name, TextureFacts& facts) { return textures_.look_at(name, facts); });
        load_sky_pictures([this](const std::string& name, LoadedSkyPicture& loaded) {
            return textures_.load_sky(name, loaded);
        });
    }
    PictureSession(const PictureSession&) = delete;
    PictureSession& operator=(const PictureSession&) = delete;

    /// Files are read again where they are needed next, pictures too if they have changed.
    void reload() { Session::reload(textures_.forget_changed()); }

    TextureStore& textures() { return textures_; }

  private:
    TextureStore textures_;
};

} // namespace graftal
