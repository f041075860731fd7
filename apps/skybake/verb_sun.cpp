#include "program.h"
namespace skybake::cli {
void add_sun(CLI::App&, Program&) {}
}
