//! From a case file to the Hugoniot u_s(u_p) of a porous solid, with uncertainty
