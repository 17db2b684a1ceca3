#include "bezel/io/vtu_data.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "bezel/base/error.hpp"

namespace bezel::files {
namespace {

constexpr std::string_view alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<int, 256> make_values() {
  std::array<int, 256> values{};
  for (int& v : values) v = -1;
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<int>(i);
  return values;
}

std::uint64_t header_word(const std::string& bytes, std::size_t index,
                          const VtuEncoding& encoding) {
  const std::size_t size = encoding.wide_header ? 8 : 4;
  std::string word = bytes.substr(index * size, size);
  if (encoding.swap) std::reverse(word.begin(), word.end());
  std::uint64_t value = 0;
  if (encoding.wide_header) {
    std::memcpy(&value, word.data(), 8);
  } else {
    std::uint32_t narrow = 0;
    std::memcpy(&narrow, word.data(), 4);
    value = narrow;
  }
  return value;
}

constexpr std::size_t block_size = std::size_t{1} << 17;

}  // namespace

std::string encode_base64(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8 | (b < n ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    for (std::size_t b = 0; b < 4; ++b) out += b <= n ? alphabet[group >> (18 - 6 * b) & 63] : '=';
  }
  return out;
}

std::string decode_base64(std::string_view text, std::size_t bytes) {
  static constexpr std::array<int, 256> values = make_values();
  std::string out;
  out.reserve(std::min(bytes, text.size() / 4 * 3 + 3) + 3);
  std::uint32_t group = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    if (out.size() >= bytes) break;
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const int value = c == '=' ? 0 : values[static_cast<unsigned char>(c)];
    if (value < 0 || (c != '=' && padding > 0)) break;
    padding += c == '=' ? 1 : 0;
    group = group << 6 | static_cast<std::uint32_t>(value);
    if (++digits < 4) continue;
    if (padding > 2) break;
    for (int b = 0; b < 3 - padding; ++b)
      out += static_cast<char>(static_cast<unsigned char>(group >> (16 - 8 * b)));
    group = 0;
    digits = padding = 0;
  }
  if (out.size() > bytes) out.resize(bytes);
  return out;
}

std::string encode_array(std::string_view bytes, bool compress) {
  const auto word = [](std::string& to, std::uint64_t value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  if (!compress) {
    std::string all;
    word(all, bytes.size());
    all += bytes;
    return encode_base64(all);
  }
  std::string sizes, blocks;
  std::vector<unsigned char> buffer(compressBound(block_size));
  std::size_t count = 0;
  for (std::size_t start = 0; start < bytes.size(); start += block_size, ++count) {
    const std::size_t size = std::min(block_size, bytes.size() - start);
    uLongf compressed = static_cast<uLongf>(buffer.size());
    if (compress2(buffer.data(), &compressed,
                  reinterpret_cast<const unsigned char*>(bytes.data() + start),
                  static_cast<uLong>(size), Z_DEFAULT_COMPRESSION) != Z_OK)
      throw InternalError("zlib could not compress a block");
    word(sizes, compressed);
    blocks.append(reinterpret_cast<const char*>(buffer.data()), compressed);
  }
  std::string header;
  word(header, count);
  word(header, block_size);
  word(header, bytes.size() % block_size);
  return encode_base64(header + sizes) + encode_base64(blocks);
}

std::string decode_array(std::string_view source, bool base64, const VtuEncoding& encoding) {
  const std::size_t size = encoding.wide_header ? 8 : 4;
  // No more than this many bytes can come out of the source.
  const std::size_t most = base64 ? source.size() / 4 * 3 + 3 : source.size();
  const auto first = [&](std::uint64_t bytes) {
    std::string out = bytes > most ? std::string()
                      : base64     ? decode_base64(source, bytes)
                                   : std::string(source.substr(0, bytes));
    if (out.size() < bytes)
      throw InputError(fmt::format("found {} bytes of data, expected {} (damaged or cut short)",
                                   base64 ? decode_base64(source, most).size() : source.size(),
                                   bytes));
    return out;
  };
  if (!encoding.zlib) {
    const std::uint64_t bytes = header_word(first(size), 0, encoding);
    if (bytes > most)
      throw InputError(
          fmt::format("its header announces {} bytes, at most {} are there", bytes, most));
    return first(size + bytes).substr(size);
  }
  const std::uint64_t count = header_word(first(size), 0, encoding);
  if (count == 0) return {};
  if (count > most / size)
    throw InputError(fmt::format("its header announces {} blocks, more than its {} bytes can hold",
                                 count, most));
  const std::string header = first((3 + count) * size);
  const std::uint64_t block = header_word(header, 1, encoding);
  const std::uint64_t last = header_word(header, 2, encoding);
  std::uint64_t start = (3 + count) * size, end = start;
  for (std::uint64_t b = 0; b < count; ++b) {
    const std::uint64_t compressed = header_word(header, 3 + b, encoding);
    if (compressed > most)
      throw InputError(
          fmt::format("block {} announces {} bytes, at most {} are there", b, compressed, most));
    end += compressed;
  }
  const std::string all = first(end);
  std::string out;
  for (std::uint64_t b = 0; b < count; ++b) {
    const std::uint64_t compressed = header_word(header, 3 + b, encoding);
    const std::uint64_t plain = b + 1 == count && last != 0 ? last : block;
    // zlib compresses at most 1032:1 [zlib.net/zlib_tech.html].
    if (plain > 1040 * (compressed + 16))
      throw InputError(
          fmt::format("block {} announces {} bytes, its {} compressed bytes cannot "
                      "hold them",
                      b, plain, compressed));
    const std::size_t offset = out.size();
    out.resize(offset + plain);
    uLongf produced = static_cast<uLongf>(plain);
    const int status = uncompress(reinterpret_cast<unsigned char*>(out.data() + offset), &produced,
                                  reinterpret_cast<const unsigned char*>(all.data() + start),
                                  static_cast<uLong>(compressed));
    if (status != Z_OK || produced != plain)
      throw InputError(fmt::format("block {} cannot be decompressed (zlib status {})", b, status));
    start += compressed;
  }
  return out;
}

void swap_bytes(std::string& bytes, std::size_t size) {
  for (std::size_t i = 0; i + size <= bytes.size(); i += size)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                 bytes.begin() + static_cast<std::ptrdiff_t>(i + size));
}

}  // namespace bezel::files
