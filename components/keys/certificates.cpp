#include "components/keys/certificates.hpp"

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <array>
#include <stdexcept>

namespace swivel {
// Not among those without a name: Authority::Keys has them as members.
namespace openssl {

struct Deleter {
  void operator()(ASN1_INTEGER* number) const { ASN1_INTEGER_free(number); }
  void operator()(BIGNUM* number) const { BN_free(number); }
  void operator()(BIO* stream) const { BIO_free_all(stream); }
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(PKCS7* signature) const { PKCS7_free(signature); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(X509_EXTENSION* extension) const { X509_EXTENSION_free(extension); }
};
template <class Object>
using Owned = std::unique_ptr<Object, Deleter>;

}  // namespace openssl

namespace {

using openssl::Owned;

constexpr int kSerialNumberBits = 127;  // X.509 has 20 bytes, and no negative ones
constexpr int kVersion3 = 2;            // X.509 counts from 0

[[noreturn]] void fail(const char* doing) {
  std::array<char, 256> reason{};
  ERR_error_string_n(ERR_get_error(), reason.data(), reason.size());
  throw std::runtime_error(std::string(doing) + ": " + reason.data());
}

void must(bool done, const char* doing) {
  if (!done) fail(doing);
}

template <class Object>
Owned<Object> own(Object* made, const char* doing) {
  must(made != nullptr, doing);
  return Owned<Object>(made);
}

std::string content_of(BIO* stream) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(stream, &data);
  return std::string(data, static_cast<std::size_t>(size));
}

Owned<BIO> memory_stream() {
  return own(BIO_new(BIO_s_mem()), "no memory");
}

// Reads from the text itself, which must outlive it.
Owned<BIO> stream_of(const std::string& text) {
  return own(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), "no memory");
}

// What Fast DDS knows besides RSA, and much shorter.
Owned<EVP_PKEY> new_key() {
  return own(EVP_EC_gen("P-256"), "no key");
}

void set_random_serial_number(X509* certificate) {
  const auto number = own(BN_new(), "no memory");
  must(BN_rand(number.get(), kSerialNumberBits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) == 1,
       "no random number");
  const auto serial = own(BN_to_ASN1_INTEGER(number.get(), nullptr), "no memory");
  must(X509_set_serialNumber(certificate, serial.get()) == 1, "serial number");
}

void set_name(X509_NAME* name, const std::string& common_name) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(common_name.data());
  must(X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, bytes,
                                  static_cast<int>(common_name.size()), -1, 0) == 1,
       "a certificate's name");
}

void extend(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const auto extension = own(X509V3_EXT_conf_nid(nullptr, &context, kind, value), value);
  must(X509_add_ext(certificate, extension.get(), -1) == 1, value);
}

// Without its issuer and signature.
Owned<X509> certificate_for(const std::string& common_name, EVP_PKEY* key, ValidFor validity) {
  auto certificate = own(X509_new(), "no memory");
  must(X509_set_version(certificate.get(), kVersion3) == 1, "a certificate's version");
  set_random_serial_number(certificate.get());
  set_name(X509_get_subject_name(certificate.get()), common_name);
  must(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), validity.from_s) != nullptr &&
           ASN1_TIME_set(X509_getm_notAfter(certificate.get()), validity.to_s) != nullptr,
       "a certificate's time");
  must(X509_set_pubkey(certificate.get(), key) == 1, "a certificate's key");
  return certificate;
}

Identity as_pem(X509* certificate, EVP_PKEY* key) {
  const auto certificate_text = memory_stream();
  const auto key_text = memory_stream();
  must(PEM_write_bio_X509(certificate_text.get(), certificate) == 1, "writing a certificate");
  must(PEM_write_bio_PrivateKey(key_text.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
       "writing a key");
  return {content_of(certificate_text.get()), content_of(key_text.get())};
}

}  // namespace

struct Authority::Keys {
  Owned<EVP_PKEY> key;
  Owned<X509> certificate;

  void issue(X509* certificate_of_other) const {
    X509_NAME* const name = X509_get_subject_name(certificate.get());
    must(X509_set_issuer_name(certificate_of_other, name) == 1, "a certificate's issuer");
    must(X509_sign(certificate_of_other, key.get(), EVP_sha256()) > 0, "signing a certificate");
  }
};

Authority::Authority(const std::string& common_name, ValidFor validity)
    : keys_(std::make_unique<Keys>()) {
  keys_->key = new_key();
  keys_->certificate = certificate_for(common_name, keys_->key.get(), validity);
  X509* const own = keys_->certificate.get();
  extend(own, own, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  extend(own, own, NID_key_usage, "critical,keyCertSign,cRLSign,digitalSignature");
  extend(own, own, NID_subject_key_identifier, "hash");
  keys_->issue(own);
}

Authority::Authority(const Identity& known) : keys_(std::make_unique<Keys>()) {
  const auto certificate = stream_of(known.certificate);
  const auto key = stream_of(known.private_key);
  keys_->certificate = own(PEM_read_bio_X509(certificate.get(), nullptr, nullptr, nullptr),
                           "the authority's certificate");
  keys_->key = own(PEM_read_bio_PrivateKey(key.get(), nullptr, nullptr, nullptr),
                   "the authority's private key");
  must(X509_check_private_key(keys_->certificate.get(), keys_->key.get()) == 1,
       "the authority's certificate and key");
}

Authority::~Authority() = default;

Identity Authority::identity() const {
  return as_pem(keys_->certificate.get(), keys_->key.get());
}

Identity Authority::vouch_for(const std::string& common_name, ValidFor validity) const {
  const auto key = new_key();
  const auto certificate = certificate_for(common_name, key.get(), validity);
  X509* const issuer = keys_->certificate.get();
  extend(certificate.get(), issuer, NID_basic_constraints, "critical,CA:FALSE");
  extend(certificate.get(), issuer, NID_key_usage, "critical,digitalSignature,keyAgreement");
  extend(certificate.get(), issuer, NID_subject_key_identifier, "hash");
  extend(certificate.get(), issuer, NID_authority_key_identifier, "keyid:always");
  keys_->issue(certificate.get());
  return as_pem(certificate.get(), key.get());
}

std::string Authority::sign(const std::string& text) const {
  constexpr int kInTheClear = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
  const auto input = stream_of(text);
  const auto signature =
      own(PKCS7_sign(keys_->certificate.get(), keys_->key.get(), nullptr, input.get(), kInTheClear),
          "signing");
  const auto output = memory_stream();
  must(SMIME_write_PKCS7(output.get(), signature.get(), input.get(), kInTheClear) == 1, "signing");
  return content_of(output.get());
}

}  // namespace swivel
