#pragma once

#include <burnish/framebuffer.hpp>
#include <burnish/texture.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>

/// Image files behind files.hpp; the contracts stand there.
namespace burnish {

Image8 read_image_file(const std::filesystem::path& path);
/// The same with 16 bits: those of the file where it has words, bytes n as n * 257.
Image16 read_image16_file(const std::filesystem::path& path);
Framebuffer read_frame_file(const std::filesystem::path& path);
void write_frame_file(const Framebuffer& frame, const std::filesystem::path& path,
                      std::string_view description);
/// The text that an image file carries; empty if there is none.
std::string read_description(const std::filesystem::path& path);
void write_image_file(const Image8& image, const std::filesystem::path& path);
void draw_text_into(Framebuffer& frame, int x, int y, std::string_view text, int size,
                    const glm::vec4& color);

}  // namespace burnish
