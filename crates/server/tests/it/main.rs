//! The integration tests of `mimique-server`, in one binary.
//!
//! The HTTP interface on SQLite and on PostgreSQL: one suite, both databases. On SQLite every topic is a
//! test of its own; on PostgreSQL four tests have a private cluster each and share the topics, each in a
//! fresh database.

mod accounts;
mod active_pairs;
mod backups;
mod client;
mod dashboard;
mod defences;
mod enrolment;
mod exports;
mod hostile_texts;
mod limits;
mod live;
mod mimicry;
mod misfits;
mod pages;
mod participant;
mod people;
mod places;
mod postgres;
mod replays;
mod researcher;
mod retention;
mod schemas;
mod sessions;
mod simulated;
mod standings;
mod storage;
mod streams;
mod study;
mod study_roles;
mod traces;
mod uploads;
mod withdrawal;

use client::TestServer;

/// Tests that share the topics on PostgreSQL, so that they run at the same time.
const SHARES: usize = 4;

/// Declares the topics: a test each on SQLite, and `on_postgres`, which runs those of one share.
macro_rules! topics {
    ($($module:ident :: $topic:ident),* $(,)?) => {
        mod sqlite {
            $(
                #[test]
                fn $topic() {
                    let folder = tempfile::tempdir().unwrap();
                    let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
                    super::client::block_on(async move {
                        super::$module::$topic(&super::TestServer::open(&url).await).await;
                    });
                }
            )*
        }

        /// Runs every topic whose place in the list, counted round and round, is that of the share.
        fn on_postgres(test: &str, share: usize) {
            let Some(cluster) = postgres::Cluster::start(test) else { return };
            client::block_on(async {
                let mut places = (0..SHARES).cycle();
                $(
                    if places.next() == Some(share) {
                        let url = cluster.fresh_database(stringify!($topic)).await;
                        eprintln!("topic {}", stringify!($topic));
                        // Each on the heap: all of them together are more than a stack holds.
                        Box::pin(async {
                            $module::$topic(&TestServer::open(&url).await).await;
                        })
                        .await;
                    }
                )*
            });
        }
    };
}

topics! {
    sessions::a_repeated_start_finds_the_same_session,
    sessions::participant_numbers_are_given_once,
    sessions::an_append_repeated_changes_nothing,
    sessions::gaps_are_reported_and_filled_in_any_order,
    sessions::a_gap_far_back_is_not_searched_for_again,
    sessions::another_body_for_a_stored_event_is_refused_and_kept_apart,
    sessions::many_appends_at_once_are_all_stored,
    sessions::a_session_goes_on_after_a_reload,
    sessions::a_restart_keeps_everything,
    sessions::completing_needs_every_event,
    sessions::a_receipt_stays_the_same,
    limits::a_session_has_so_much_and_no_more,
    sessions::the_code_is_given_only_at_the_end,
    sessions::withdrawal_deletes_answers_and_identifiers,
    sessions::withdrawal_needs_the_code,
    sessions::unknown_sessions_and_studies_are_not_found,
    sessions::bad_requests_are_refusals,
    sessions::oversized_bodies_are_refused,
    backups::a_backup_restores_everything,
    backups::a_backup_fills_only_what_is_empty,
    backups::deletions_reach_the_backups,
    defences::browsers_are_told_what_they_may_do,
    defences::a_part_of_a_video_is_sent,
    defences::one_address_cannot_ask_without_end,
    defences::a_nul_is_refused_wherever_it_comes,
    defences::metrics_are_the_operators,
    defences::logs_hold_no_answers,
    defences::panics_of_pages_are_logged,
    defences::reports_of_panics_are_few,
    defences::a_token_is_known_in_any_case,
    defences::two_hosts_are_refused,
    defences::links_begin_with_the_address_that_people_type,
    hostile_texts::no_text_of_a_participant_breaks_a_consumer,
    enrolment::who_only_looks_or_is_turned_away_holds_no_place_and_uses_no_identifier,
    enrolment::the_slot_of_a_drop_out_goes_to_the_next,
    enrolment::a_sign_of_life_keeps_the_slot,
    enrolment::slots_are_given_one_after_the_other,
    enrolment::the_address_puts_a_participant_into_a_condition,
    enrolment::conditions_are_balanced_over_those_who_finish,
    enrolment::the_study_closes_when_it_is_full,
    places::one_address_cannot_fill_a_study,
    places::a_place_is_held_by_a_page_that_is_heard_of,
    enrolment::the_study_has_hours,
    enrolment::an_identifier_takes_part_once,
    enrolment::a_browser_takes_part_once,
    enrolment::a_browser_takes_part_once_in_a_frame_too,
    enrolment::nothing_finer_than_a_browsers_name_is_kept,
    enrolment::a_clock_that_jumps_back_loses_nothing,
    retention::answers_are_deleted_a_week_after_their_time_is_over,
    retention::a_wrong_clock_deletes_nothing,
    retention::an_owner_keeps_answers_and_confirms_the_clock,
    standings::everybody_agrees_on_every_session,
    storage::one_impossible_change_does_not_take_others_with_it,
    storage::what_was_accepted_before_the_end_is_committed,
    storage::a_later_schema_is_refused,
    mimicry::the_camera_is_for_pages_that_measure_alone,
    mimicry::tracks_are_exported_and_deleted_with_their_session,
    misfits::a_strangers_event_reaches_no_table,
    misfits::what_comes_after_the_receipt_changes_no_standing,
    pages::only_pages_that_are_named_may_embed_a_study,
    pages::pages_carry_a_strict_policy,
    pages::assets_and_packs_are_kept_for_ever,
    pages::the_study_tells_participants_no_secrets,
    pages::the_server_says_that_it_is_ready,
    pages::a_database_that_cannot_be_written_is_not_ready,
    replays::a_session_is_gone_through_again,
    replays::a_replay_is_for_those_who_may_read_answers,
    exports::the_tidy_table_holds_every_answer,
    exports::every_form_is_the_same_each_time,
    exports::the_other_forms_hold_the_same_answers,
    exports::a_download_comes_in_pieces,
    exports::a_data_set_is_zipped_while_it_is_sent,
    exports::a_wide_export_is_as_of_its_beginning,
    exports::a_psych_ds_folder_explains_every_column,
    exports::identifiers_are_exported_only_when_asked_for,
    exports::each_session_is_read_by_its_own_version,
    exports::a_study_must_be_named_where_there_are_several,
    active_pairs::pages_are_told_what_others_answered,
    simulated::a_simulated_export_is_the_servers,
    accounts::the_first_link_makes_the_owner_once,
    accounts::links_expire_and_secrets_are_not_stored,
    accounts::logging_in_begins_a_new_session,
    accounts::behind_tls_cookies_are_secure,
    accounts::wrong_passwords_wait_and_say_nothing,
    accounts::forged_forms_change_nothing,
    accounts::each_role_may_do_what_it_may,
    study_roles::a_role_in_one_study_is_none_in_another,
    accounts::tokens_do_what_their_role_may_until_revoked,
    accounts::a_lost_password_is_replaced,
    accounts::a_disabled_account_has_no_way_in,
    accounts::no_token_manages_people,
    accounts::nobody_can_lock_an_owner_out,
    accounts::one_address_cannot_try_every_account,
    accounts::somebody_always_owns_the_server,
    accounts::the_log_says_who_did_what,
    accounts::what_is_hosted_is_for_researchers,
    researcher::the_page_shows_what_was_stored,
    researcher::a_change_is_told_at_once,
    researcher::stored_events_are_told_to_who_may_export,
    streams::an_event_of_any_type_is_streamed,
    streams::a_lost_right_ends_a_stream_of_a_busy_study,
    dashboard::the_list_of_participants_has_pages,
    dashboard::sums_are_kept_and_are_what_is_counted_anew,
    dashboard::a_deleted_session_leaves_no_sums,
    dashboard::thresholds_so_far_are_shown,
    dashboard::both_clips_of_a_pair_are_in_the_balance,
    researcher::exports_are_files,
    researcher::an_exclusion_is_in_export_and_report,
    researcher::an_owner_deletes_a_participant_who_asks_for_it,
    researcher::one_account_has_so_many_streams_and_no_more,
    researcher::scripts_export_as_the_description_says,
    researcher::refusals_are_in_the_readers_language,
    traces::what_is_deleted_leaves_no_trace,
    traces::a_reader_only_puts_it_off,
    uploads::a_study_of_the_studio_is_hosted_for_its_preview,
    uploads::an_uploaded_study_is_hosted_as_a_pilot,
    uploads::a_study_with_errors_is_refused_with_all_of_them,
    uploads::pictures_and_signed_videos_are_hosted,
    uploads::the_studio_alone_hosts_what_it_makes,
    uploads::what_fails_is_taken_away,
    uploads::an_owner_of_a_study_uploads_it_and_no_other,
    uploads::hostile_uploads_leave_nothing,
    uploads::an_archive_is_refused_for_its_names_and_its_study_file,
    withdrawal::a_participant_redeems_the_code_alone,
    withdrawal::codes_cannot_be_tried_without_end,
    withdrawal::a_right_code_is_redeemed_after_wrong_ones,
    withdrawal::a_researcher_redeems_a_code_that_was_sent,
    withdrawal::a_withdrawal_of_the_page_is_in_the_log,
}

#[test]
fn postgres_passes_the_first_share_of_the_topics() {
    on_postgres("postgres_passes_the_first_share_of_the_topics", 0);
}

#[test]
fn postgres_passes_the_second_share_of_the_topics() {
    on_postgres("postgres_passes_the_second_share_of_the_topics", 1);
}

#[test]
fn postgres_passes_the_third_share_of_the_topics() {
    on_postgres("postgres_passes_the_third_share_of_the_topics", 2);
}

#[test]
fn postgres_passes_the_last_share_of_the_topics() {
    on_postgres("postgres_passes_the_last_share_of_the_topics", SHARES - 1);
}
