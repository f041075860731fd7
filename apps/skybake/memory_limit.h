// The memory that the program may take: an error in time instead of a kill.
#pragma once

namespace skybake::cli {

/// Bounds the program's data to what the machine has to give now, main memory and swap, so that what is too much ends
/// in std::bad_alloc; without a bound Linux promises more than it has, and kills. A lower bound of the user's stays.
/// Does nothing where the system does not tell, and under sanitizers, which reserve terabytes.
void limit_memory();

/// Takes the bound off again, for programs that are started from here: a browser has memory of its own to reserve.
void lift_memory_limit();

}  // namespace skybake::cli
