#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/texture.hpp>
#include <filesystem>

/// Image files behind files.hpp; the contracts stand there.
namespace burnish {

Image8 read_image_file(const std::filesystem::path& path);
void write_frame_file(const Framebuffer& frame, const std::filesystem::path& path);
void write_image_file(const Image8& image, const std::filesystem::path& path);

}  // namespace burnish
