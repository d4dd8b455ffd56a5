// The assembler includes the template: a compiler would need megabytes of numbers in the source.
#include "page/html.h"

#ifdef RADIOSITY_PAGE_TEMPLATE

asm(".section .rodata\n"
    ".hidden radiosity_page_template_begin\n"
    ".hidden radiosity_page_template_end\n"
    ".global radiosity_page_template_begin\n"
    ".global radiosity_page_template_end\n"
    "radiosity_page_template_begin:\n"
    ".incbin \"" RADIOSITY_PAGE_TEMPLATE
    "\"\n"
    "radiosity_page_template_end:\n"
    ".byte 0\n"
    ".text\n");

extern "C" {
extern const char radiosity_page_template_begin[];
extern const char radiosity_page_template_end[];
}

std::string_view radiosity::page::pageTemplate() {
  return {radiosity_page_template_begin, radiosity_page_template_end};
}

#else

std::string_view radiosity::page::pageTemplate() { return {}; }

#endif
