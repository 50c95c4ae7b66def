"""The laboratory in one vocabulary: materials, bodies, strikers and specimens, in SI units."""
