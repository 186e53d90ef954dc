#include "base/sha256.h"

#include <openssl/evp.h>

#include "base/hex.h"

namespace trephine {

struct Sha256::Context {
  EVP_MD_CTX* md = EVP_MD_CTX_new();
  ~Context() { EVP_MD_CTX_free(md); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  EVP_DigestInit_ex(context_->md, EVP_sha256(), nullptr);
}

Sha256::~Sha256() = default;

void Sha256::add(const void* bytes, std::size_t count) {
  EVP_DigestUpdate(context_->md, bytes, count);
}

std::string Sha256::hex() {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_DigestFinal_ex(context_->md, digest, &size);
  return hexOf({digest, size});
}

std::string sha256Hex(const void* bytes, std::size_t count) {
  Sha256 sha;
  sha.add(bytes, count);
  return sha.hex();
}

}  // namespace trephine
