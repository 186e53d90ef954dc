#include "jpeg2000_fixture.h"

#include <gtest/gtest.h>
#include <openjpeg.h>

#include <algorithm>

namespace trephine::test {

Picture ramp(int bits, bool is_signed, int columns, int rows) {
  Picture picture{columns, rows, bits, is_signed};
  const int range = 1 << bits, low = is_signed ? -range / 2 : 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      picture.samples.push_back(low + (x * 1021 + y * 617 + (x * y) % 13) % range);
    }
  }
  return picture;
}

std::vector<std::uint8_t> encode(const Picture& picture, const Coding& coding) {
  opj_cparameters_t parameters;
  opj_set_default_encoder_parameters(&parameters);
  parameters.numresolution = 4;
  parameters.irreversible = coding.irreversible;
  parameters.tcp_numlayers = coding.layers;
  for (int i = 0; i < coding.layers; ++i) {
    parameters.tcp_rates[i] = coding.ratio * float(coding.layers - i);
  }
  parameters.cp_disto_alloc = 1;
  if (coding.tile) {
    parameters.tile_size_on = OPJ_TRUE;
    parameters.cp_tdx = parameters.cp_tdy = coding.tile;
  }
  if (coding.precinct) {
    parameters.csty |= 1;
    parameters.res_spec = parameters.numresolution;
    for (int i = 0; i < parameters.res_spec; ++i) {
      parameters.prcw_init[i] = parameters.prch_init[i] = coding.precinct;
    }
  }
  std::vector<opj_image_cmptparm_t> components(std::size_t(coding.channels));
  for (auto& component : components) {
    component = {};
    component.dx = component.dy = 1;
    component.w = unsigned(picture.columns);
    component.h = unsigned(picture.rows);
    component.prec = unsigned(picture.bits);
    component.sgnd = picture.is_signed;
  }
  opj_image_t* image =
      opj_image_create(unsigned(coding.channels), components.data(), OPJ_CLRSPC_GRAY);
  image->x1 = unsigned(picture.columns);
  image->y1 = unsigned(picture.rows);
  for (int c = 0; c < coding.channels; ++c) {
    std::ranges::copy(picture.samples, image->comps[c].data);
  }

  struct Sink {
    std::vector<std::uint8_t> bytes;
    std::size_t at = 0;
  } sink;
  opj_stream_t* stream = opj_stream_default_create(OPJ_FALSE);
  opj_stream_set_user_data(stream, &sink, nullptr);
  opj_stream_set_write_function(stream, [](void* from, OPJ_SIZE_T count, void* user) {
    Sink& to = *static_cast<Sink*>(user);
    to.bytes.resize(std::max(to.bytes.size(), to.at + count));
    std::copy_n(static_cast<std::uint8_t*>(from), count, to.bytes.begin() + std::ptrdiff_t(to.at));
    to.at += count;
    return count;
  });
  opj_stream_set_skip_function(stream, [](OPJ_OFF_T count, void* user) {
    static_cast<Sink*>(user)->at += std::size_t(count);
    return count;
  });
  opj_stream_set_seek_function(stream, [](OPJ_OFF_T to, void* user) -> OPJ_BOOL {
    static_cast<Sink*>(user)->at = std::size_t(to);
    return OPJ_TRUE;
  });
  opj_codec_t* codec = opj_create_compress(coding.jp2 ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K);
  EXPECT_TRUE(opj_setup_encoder(codec, &parameters, image));
  EXPECT_TRUE(opj_start_compress(codec, image, stream) && opj_encode(codec, stream) &&
              opj_end_compress(codec, stream));
  opj_stream_destroy(stream);
  opj_destroy_codec(codec);
  opj_image_destroy(image);
  return sink.bytes;
}

Jpeg2000Expectation expectation(const Picture& picture) {
  return {picture.rows, picture.columns, picture.bits > 8 ? 16 : 8, picture.bits,
          picture.is_signed};
}

Decoded decode(const std::vector<std::uint8_t>& bytes, const Jpeg2000Expectation& expected) {
  std::vector<std::int16_t> words(std::size_t(expected.rows) * std::size_t(expected.columns));
  const Status status = decodeJpeg2000(bytes, expected, words.data());
  if (!status.ok()) {
    EXPECT_EQ(status.error().code.str(), "UNREADABLE");
    return {{}, status.error().what};
  }
  Decoded decoded;
  for (const std::int16_t word : words) {
    decoded.values.push_back(expected.is_signed ? word : int(std::uint16_t(word)));
  }
  return decoded;
}

}  // namespace trephine::test
