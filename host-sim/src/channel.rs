//! The V2X channel: a message enters, its copies leave with delay, loss, duplication and reordering, seeded.
