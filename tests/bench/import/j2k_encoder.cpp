#include "bench/import/j2k_encoder.h"

#include <openjpeg.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>

namespace trephine::bench {

namespace {

// Where the encoder writes; it comes back to fill in lengths.
struct Sink {
  std::vector<std::uint8_t> bytes;
  std::size_t at = 0;
};

OPJ_SIZE_T writeBytes(void* data, OPJ_SIZE_T count, void* user) {
  Sink& sink = *static_cast<Sink*>(user);
  sink.bytes.resize(std::max(sink.bytes.size(), sink.at + count));
  std::memcpy(sink.bytes.data() + sink.at, data, count);
  sink.at += count;
  return count;
}

OPJ_OFF_T skip(OPJ_OFF_T count, void* user) {
  static_cast<Sink*>(user)->at += std::size_t(count);
  return count;
}

OPJ_BOOL seek(OPJ_OFF_T to, void* user) {
  static_cast<Sink*>(user)->at = std::size_t(to);
  return OPJ_TRUE;
}

}  // namespace

std::vector<std::uint8_t> encodeJ2k(const std::vector<std::uint16_t>& words, int columns, int rows,
                                    int bits) {
  opj_image_cmptparm_t component{};
  component.dx = component.dy = 1;
  component.w = OPJ_UINT32(columns);
  component.h = OPJ_UINT32(rows);
  component.prec = OPJ_UINT32(bits);
  const std::unique_ptr<opj_image_t, decltype(&opj_image_destroy)> image(
      opj_image_create(1, &component, OPJ_CLRSPC_GRAY), opj_image_destroy);
  const std::unique_ptr<opj_codec_t, decltype(&opj_destroy_codec)> codec(
      opj_create_compress(OPJ_CODEC_J2K), opj_destroy_codec);
  const std::unique_ptr<opj_stream_t, decltype(&opj_stream_destroy)> stream(
      opj_stream_default_create(OPJ_FALSE), opj_stream_destroy);
  if (!image || !codec || !stream) return {};
  image->x1 = component.w;
  image->y1 = component.h;
  std::copy(words.begin(), words.end(), image->comps[0].data);

  opj_cparameters_t parameters;
  opj_set_default_encoder_parameters(&parameters);
  parameters.tcp_numlayers = 1;
  parameters.cp_disto_alloc = 1;  // one layer of rate 0: all bits
  // As many halvings as the picture has room for, 5 at most.
  parameters.numresolution = std::min(6, int(std::bit_width(unsigned(std::min(columns, rows)))));

  Sink sink;
  opj_stream_set_user_data(stream.get(), &sink, nullptr);
  opj_stream_set_write_function(stream.get(), writeBytes);
  opj_stream_set_skip_function(stream.get(), skip);
  opj_stream_set_seek_function(stream.get(), seek);
  if (!opj_setup_encoder(codec.get(), &parameters, image.get()) ||
      !opj_start_compress(codec.get(), image.get(), stream.get()) ||
      !opj_encode(codec.get(), stream.get()) || !opj_end_compress(codec.get(), stream.get())) {
    return {};
  }
  return std::move(sink.bytes);
}

}  // namespace trephine::bench
