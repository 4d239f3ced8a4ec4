//! Equations of state, strength, failure and analytic shock solutions of solids at one point of matter
