//! CAN buses behind one trait.
