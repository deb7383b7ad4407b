#include "client/sdl/screenshot.h"

#include <cstdint>
#include <stb_image_write.h>
#include <vector>

namespace fts::sdl {

bool write_png(const PixelView& picture, const std::string& path, std::string& error) {
    constexpr int kChannels = 3;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(picture.width) *
                  static_cast<std::size_t>(picture.height) * kChannels);
    for (int y = 0; y < picture.height; ++y) {
        const std::uint32_t* row = picture.pixels + y * picture.stride;
        for (int x = 0; x < picture.width; ++x) {
            for (const unsigned shift : {16U, 8U, 0U}) {
                bytes.push_back(static_cast<std::uint8_t>((row[x] >> shift) & 0xffU));
            }
        }
    }
    if (stbi_write_png(path.c_str(), picture.width, picture.height, kChannels, bytes.data(),
                       picture.width * kChannels) != 0) {
        return true;
    }
    error = "Cannot write the screenshot to " + path +
            ". Give a file in a folder that exists and may be written to.";
    return false;
}

}  // namespace fts::sdl
