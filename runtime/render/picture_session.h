#pragma once

#include "compiler/session/session.h"
#include "runtime/image_files/texture_store.h"

namespace graftal {

/// A session for pictures: it has the textures that the model names, too.
class PictureSession : public Session {
  public:
    explicit PictureSession(std::string path, Keep keep = Keep::everything) : Session(std::move(path), keep) {
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
