// Stands in the tarball for JBIG-KIT, the one library under the GPL alone that Debian's libtiff loads: the functions that libtiff calls.
// Trocar reads and writes no TIFF. Decoding fails with an error, which libtiff reports; encoding, which cannot fail, ends the program.
#include <stddef.h>
#include <stdlib.h>

enum { kNotSupported = 1 };

void jbg_dec_init(void* decoder) { (void)decoder; }
int jbg_dec_in(void* decoder, unsigned char* bytes, size_t size, size_t* used) {
  (void)decoder, (void)bytes, (void)size, (void)used;
  return kNotSupported;
}
unsigned char* jbg_dec_getimage(const void* decoder, int plane) {
  (void)decoder, (void)plane;
  return NULL;
}
unsigned long jbg_dec_getsize(const void* decoder) {
  (void)decoder;
  return 0;
}
void jbg_dec_free(void* decoder) { (void)decoder; }
int jbg_newlen(unsigned char* bytes, size_t size) {
  (void)bytes, (void)size;
  return 0;
}
const char* jbg_strerror(int error) {
  (void)error;
  return "JBIG is not supported";
}
void jbg_enc_init(void* encoder) {
  (void)encoder;
  abort();
}
void jbg_enc_out(void* encoder) { (void)encoder; }
void jbg_enc_free(void* encoder) { (void)encoder; }
