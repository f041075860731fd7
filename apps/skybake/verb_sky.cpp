#include "program.h"
namespace skybake::cli {
void add_sky(CLI::App&, Program&) {}
}
