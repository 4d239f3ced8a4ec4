//! Problems with known answers, errors against them, gates
