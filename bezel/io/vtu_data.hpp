#pragma once
// Internal to io: the bytes of data arrays in VTK XML files (base64, zlib blocks).

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bezel::files {

std::string encode_base64(std::string_view bytes);

/// Decodes until `bytes` bytes are there, the text ends, or it is no base64 (then shorter).
/// White space is skipped; padding ends a group, not the text: VTK pads the header on its own.
std::string decode_base64(std::string_view text, std::size_t bytes);

/// An array's bytes as VTK writes them in base64 with UInt64 headers: one header, or zlib blocks.
std::string encode_array(std::string_view bytes, bool compress);

/// How a file stores its arrays.
struct VtuEncoding {
  bool wide_header = false;  ///< UInt64, else UInt32
  bool swap = false;         ///< bytes of numbers run the other way than the machine's
  bool zlib = false;
};

/// The bytes of an array. `base64`: the source is base64 text, else raw bytes.
/// @throws InputError (without a place) when the source is too short or damaged; nothing is
///         allocated for sizes that the source cannot hold
std::string decode_array(std::string_view source, bool base64, const VtuEncoding& encoding);

/// Reverses the bytes of each value of the given size.
void swap_bytes(std::string& bytes, std::size_t size);

}  // namespace bezel::files
