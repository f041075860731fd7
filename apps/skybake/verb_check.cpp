#include "program.h"
namespace skybake::cli {
void add_check(CLI::App&, Program&) {}
}
