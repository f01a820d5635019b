#pragma once

#include <memory>
#include <string>
#include <thread>

#include "runtime/image_files/texture_store.h"
#include "runtime/studio/studio_home.h"
#include "runtime/system/worker_threads.h"

namespace graftal {

/// The model that `graftal studio` opens.
struct StudioModel {
    OpenedModel opened;
    std::string root; ///< files that pages' models name lie in this folder
};

/// Reads the model of the command line, or gives an example without one.
Status read_studio_model(const std::string& path, StudioModel& model);

/// The program behind a page's session: the disk, threads and all engines.
class ProgramHome final : public StudioHome {
  public:
    explicit ProgramHome(std::shared_ptr<const StudioModel> model) : model_(std::move(model)) {}
    ~ProgramHome() override { end_jobs(); }

    std::string name() const override { return "program"; }
    std::string version() const override;
    OpenedModel opened() const override { return model_->opened; }
    std::vector<std::string> engines() const override;
    std::vector<std::string> formats() const override;
    std::string deflated(std::string_view bytes) const override;
    const Files& files() const override;
    std::string root() const override { return model_->root; }
    const Workers& workers(int threads) override;
    void equip(Session& session) override;
    Translator translator() const override;
    Status load_textures(const Graph& graph, const View& view, ModelTextures& textures) override;
    void make_file(FileJob job, CancelFlag cancel, OnShare on_share, OnResult on_result) override;
    void draw_picture(FileJob job, CancelFlag cancel, OnPicture on_picture, OnEnd on_end) override;
    void end_jobs() override;

  private:
    std::shared_ptr<const StudioModel> model_;
    WorkerThreads workers_{0};
    TextureStore textures_;
    std::thread file_maker_, drawer_;
};

} // namespace graftal
